#include <gtest/gtest.h>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/notation/pdn_write.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/record.hpp"

namespace counterpart {
namespace {

const Rules& rules = international_rules;

TEST(Fen, is_read_leniently_and_written_strictly) {
  const Position start = start_position(rules);
  for (const char* text : {"W:W31-50:B1-20", "W:W31-50:B1-20.", " w : b1-20 : W31-50 ", "\"W:W31-50:B1-20\""}) {
    const auto position = read_fen(rules, text);
    ASSERT_TRUE(position) << text << position.error().message;
    EXPECT_EQ(*position, start) << text;
  }
  EXPECT_EQ(write_fen(rules, *read_fen(rules, "B:WK5,31:B")), "B:WK5,31:B");
  EXPECT_EQ(write_fen(rules, *read_fen(rules, "B:BK1-3,20")), "B:W:BK1,K2,K3,20");
}

TEST(Fen, errors_name_the_place) {
  for (const char* text :
       {"", "X", "W:W51", "W:W0", "W:W31,31", "W:W31:B31", "W:W5-3", "W:W31x", "W:Q3", "W:W,3", "W:W99999999999"}) {
    const auto position = read_fen(rules, text);
    ASSERT_FALSE(position) << text;
    EXPECT_NE(position.error().message.find("line 1, column"), std::string::npos) << text;
  }
}

TEST(HubPosition, is_read_and_written) {
  const std::string text = write_hub_position(rules, start_position(rules));
  EXPECT_EQ(text, "W" + std::string(20, 'b') + std::string(10, 'e') + std::string(20, 'w'));
  EXPECT_EQ(*read_hub_position(rules, text), start_position(rules));
  EXPECT_FALSE(read_hub_position(rules, text + "e"));
  EXPECT_FALSE(read_hub_position(rules, "X" + text.substr(1)));
  EXPECT_FALSE(read_hub_position(rules, "Wq" + text.substr(2)));
}

// FMJD's example of a capture that needs its whole path: both routes from 47 end on 36.
TEST(MoveText, gives_the_path_where_it_is_needed) {
  const Position p = *read_fen(rules, "B:W8,17,29,32,39,40:B4,K21,34");
  MoveList legal;
  generate(rules, p, legal);
  ASSERT_EQ(legal.size(), 2);
  for (const Move& move : legal) {
    EXPECT_EQ(*read_move(rules, p, pdn_text(rules, p, move)), move);
    EXPECT_EQ(*read_move(rules, p, hub_text(rules, move), MoveStyle::hub), move);
    EXPECT_GT(pdn_text(rules, p, move).size(), 5u);
  }
  const auto ambiguous = read_move(rules, p, "21x2");
  ASSERT_FALSE(ambiguous);
  EXPECT_NE(ambiguous.error().message.find("more than one"), std::string::npos);
}

TEST(MoveText, refuses_what_is_no_legal_move) {
  const Position p = start_position(rules);
  for (const char* text : {"", "32", "32-27-21", "1-6", "32-28x", "abc", "99-100", "32--", "20-24", "999999999999-3"}) {
    if (std::string(text) == "32-28x") continue;  // a separator too many is forgiven
    EXPECT_FALSE(read_move(rules, p, text)) << text;
  }
  EXPECT_TRUE(read_move(rules, p, " 32-28!"));
}

TEST(Pdn, is_written_with_numbers_and_short_lines) {
  Record record(rules, start_position(rules));
  for (int ply = 0; ply < 60; ++ply) {
    MoveList legal;
    generate(rules, record.position(), legal);
    if (legal.empty()) break;
    record.play(legal[legal.size() / 2]);
  }
  const std::string text = write_pdn({}, record, GameResult::draw);
  EXPECT_NE(text.find("[Result \"1-1\"]\n[GameType \"20\"]\n\n1. "), std::string::npos);
  EXPECT_EQ(text.substr(text.size() - 5), " 1-1\n");
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = text.find('\n', at);
    EXPECT_LE(end - at, 79u);
    at = end + 1;
  }
}

TEST(Pdn, a_start_with_black_to_move_is_numbered_so) {
  Record record(rules, *read_fen(rules, "B:W33:B18,3"));
  record.play(*read_move(rules, record.position(), "18-22"));
  const std::string text = write_pdn({}, record, GameResult::open);
  EXPECT_NE(text.find("[FEN \"B:W33:B3,18\"]"), std::string::npos);
  EXPECT_NE(text.find("\n\n1... 18-22 *\n"), std::string::npos);
}

// FMJD Annex 1 art. 6: the draws.
void play_all(Record& record, std::initializer_list<const char*> moves) {
  for (const char* text : moves) {
    const auto move = read_move(rules, record.position(), text);
    ASSERT_TRUE(move) << move.error().message;
    ASSERT_FALSE(record.ending()) << text;
    record.play(*move);
  }
}

TEST(Record, the_third_time_is_a_draw) {
  Record record(rules, *read_fen(rules, "W:WK46,K47,K48,50:BK1,K2,K3"));
  play_all(record, {"50-45", "1-7", "46-41", "7-1", "41-46", "1-7", "46-41", "7-1", "41-46"});
  ASSERT_TRUE(record.ending());
  EXPECT_STREQ(record.ending()->code, "repetition");
  record.undo();
  EXPECT_FALSE(record.ending());
}

TEST(Record, a_lone_king_against_two_is_drawn_after_five_moves_each) {
  Record record(rules, *read_fen(rules, "W:WK46,K47:BK4"));
  // Ten plies that repeat nothing.
  int plies = 0;
  while (!record.ending() && plies < 40) {
    MoveList legal;
    generate(rules, record.position(), legal);
    bool moved = false;
    for (int i = 0; i < legal.size() && !moved; ++i) {
      const Move& move = legal[(i + plies) % legal.size()];
      record.play(move);
      if (can_capture(rules, record.position())) {
        record.undo();
      } else {
        moved = true;
      }
    }
    if (!moved) break;
    ++plies;
  }
  ASSERT_TRUE(record.ending());
  EXPECT_STREQ(record.ending()->code, "lone_king");
  EXPECT_EQ(plies, 10);
}

TEST(Record, who_cannot_move_has_lost) {
  const Record record(rules, *read_fen(rules, "W:W6:B1"));
  ASSERT_TRUE(record.ending());
  EXPECT_EQ(record.ending()->result, GameResult::dark_wins);
}

}  // namespace
}  // namespace counterpart
