#include <gtest/gtest.h>

#include "tests/game_controller/game/simulated_game.hpp"

namespace counterpart::simulated {
namespace {

GameOptions options_from(const std::string& fen) {
  GameOptions options;
  options.start_fen = fen;
  return options;
}

// All sentences of this code until such an event.
std::vector<std::string> said(Play& play, const std::string& code, EventKind until, int frames = 1500) {
  std::vector<std::string> texts;
  for (int i = 0; i < frames; ++i) {
    const GameOutputs out = play.step();
    for (const Command& command : out.commands) {
      const auto* say = std::get_if<Say>(&command.action);
      if (say != nullptr && say->code == code) texts.push_back(say->text);
    }
    for (const GameEvent& e : out.events) {
      if (e.kind == until) return texts;
    }
  }
  return texts;
}

Control hint(const std::string& text) {
  Control control;
  control.kind = ControlKind::hint;
  control.text = text;
  return control;
}

TEST(Explain, a_hint_is_a_good_move_with_what_follows) {
  Play play(options_from("B:W31,37:B20,13"), 5);  // two men run; any sensible hint begins with a legal move
  play.player_acts = false;
  ASSERT_TRUE(play.until(EventKind::turn));
  play.controls = {hint("")};
  std::string text;
  for (const Command& command : play.step().commands) {
    if (const auto* say = std::get_if<Say>(&command.action); say != nullptr && say->code == "hint") text = say->text;
  }
  ASSERT_NE(text.find("You could play "), std::string::npos);
  const std::string move = text.substr(15, text.find_first_of(",.", 15) - 15);
  EXPECT_TRUE(read_move(play.rules(), play.position(), move)) << text;
}

TEST(Explain, what_was_wrong_with_the_last_move) {
  Play play(options_from("B:W33,38,43:B19,13,9"), 5);
  play.player_acts = false;
  ASSERT_TRUE(play.until(EventKind::turn));
  play.controls = {hint("last")};
  EXPECT_EQ(play.step().rejected.size(), 1u);  // none yet
  play.put((play.table.pieces & ~square_mask(19, 10)) | square_mask(24, 10));
  ASSERT_TRUE(play.until(EventKind::move));
  play.controls = {hint("last")};
  std::string text;
  for (const Command& command : play.step().commands) {
    if (const auto* say = std::get_if<Say>(&command.action)) text += say->text;
  }
  EXPECT_NE(text.find("19-24"), std::string::npos) << text;
}

TEST(Explain, a_man_that_captures_backwards_surprises_once) {
  Play play(options_from("B:W28,45,50:B32,7,8"), 5);  // 32 captures upwards: backwards for dark
  play.player_acts = false;
  ASSERT_TRUE(play.until(EventKind::turn));
  play.put((play.table.pieces & ~square_mask(32, 10)) | square_mask(23, 10));
  EXPECT_EQ(said(play, "backward_capture", EventKind::turn).size(), 1u);
}

TEST(Explain, the_majority_rule_is_told_when_it_decides) {
  Play play(options_from("W:W28,37,50:B22,12,31,1"), 5);  // 28 takes two, 37 would take one
  play.player_acts = false;
  const auto texts = said(play, "majority", EventKind::waiting_for_removal);
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_NE(texts[0].find("28"), std::string::npos);
}

TEST(Explain, an_opponent_that_gives_up_has_lost) {
  Play play(options_from("W:W31,37:B20,13"), 5);
  play.player_acts = false;
  for (int i = 0; i < 300 && !play.thinking_about; ++i) play.step();
  ASSERT_TRUE(play.thinking_about);
  GameInputs in;
  in.now_ns = play.frame * frame_ns;
  in.engine_move = opponent_resigns;
  const GameOutputs out = play.game.step(in);
  EXPECT_EQ(play.game.board_state().result, GameResult::dark_wins);
  EXPECT_EQ(play.game.board_state().phase, GamePhase::over);
}

}  // namespace
}  // namespace counterpart::simulated
