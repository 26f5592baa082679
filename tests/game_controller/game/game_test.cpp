#include "game_controller/game/game.hpp"

#include <gtest/gtest.h>

#include "game_controller/game/lost_pieces.hpp"
#include "game_controller/rules/record.hpp"
#include "tests/game_controller/game/simulated_game.hpp"

namespace counterpart {
namespace {

using simulated::frame_ns;
using simulated::Play;

GameOptions options_from(const std::string& fen = "") {
  GameOptions options;
  options.start_fen = fen;
  return options;
}

// The judge of a whole game: every move of the record is legal, and the record's end is the position that is shown.
void expect_sound(const Play& play) {
  const Rules& rules = play.rules();
  Record record(rules,
                play.options.start_fen.empty() ? start_position(rules) : *read_fen(rules, play.options.start_fen));
  for (const std::string& text : play.game.board_state().moves) {
    const auto move = read_move(rules, record.position(), text);
    ASSERT_TRUE(move) << move.error().message;
    record.play(*move);
  }
  EXPECT_EQ(write_squares(rules, record.position()), play.game.board_state().squares);
}

TEST(Game, a_whole_game_is_played_to_its_end) {
  for (const char* rules : {"international", "brazilian", "english"}) {
    GameOptions options;
    options.rules = rules;
    options.board.squares = find_rules(rules)->squares;
    Play play(options, 7);
    ASSERT_TRUE(play.until(EventKind::game_over, 40'000)) << rules;
    expect_sound(play);
    EXPECT_GE(play.game.board_state().moves.size(), 20u) << rules;
    EXPECT_GE(play.count(EventKind::captured), 4) << rules;
    EXPECT_EQ(play.count(EventKind::illegal_move), 0) << rules;
    EXPECT_EQ(play.count(EventKind::waiting_for_removal) - play.count(EventKind::removal_done),
              play.game.board_state().to_remove.empty() ? 0 : 1);
    EXPECT_TRUE(play.renderer.ids_grow);
    // At every change of turn the screen showed the virtual pieces where the position has them.
    EXPECT_EQ(play.moves_drawn_right, play.count(EventKind::turn)) << rules;
    EXPECT_NE(play.game.board_state().result, GameResult::open);
  }
}

TEST(Game, the_virtual_player_may_have_the_dark_pieces) {
  GameOptions options;
  options.virtual_side = Side::dark;
  Play play(options, 3);
  ASSERT_TRUE(play.until(EventKind::game_over, 40'000));
  expect_sound(play);
  EXPECT_EQ(play.moves_drawn_right, play.count(EventKind::turn));
}

GameOptions both_real(const std::string& fen = "") {
  GameOptions options = options_from(fen);
  options.both_real = true;
  return options;
}

TEST(Game, all_pieces_may_be_real) {
  for (const Side side : {Side::light, Side::dark}) {
    GameOptions options = both_real();
    options.virtual_side = side;
    Play play(options, 11);
    ASSERT_TRUE(play.until(EventKind::game_over, 60'000));
    expect_sound(play);
    EXPECT_GE(play.game.board_state().moves.size(), 20u);
    EXPECT_GE(play.count(EventKind::captured), 4);
    EXPECT_EQ(play.count(EventKind::illegal_move), 0);
    EXPECT_EQ(play.count(EventKind::waiting_for_removal), 0) << "who captures takes off";
    EXPECT_TRUE(play.renderer.pieces.empty()) << "nothing is drawn, all of it is there";
    EXPECT_EQ(play.table.pieces, play.position().light | play.position().dark);
    EXPECT_EQ(*play.table.light, play.position().light);
  }
}

TEST(Game, another_move_than_he_asked_for_is_not_taken_for_it) {
  Play play(both_real("W:W32,33:B1,2"), 1);
  play.player_does_favours = false;
  std::string asked;
  for (int i = 0; i < 200 && asked.empty(); ++i) {
    for (const GameEvent& e : play.step().events)
      if (e.code == "make_it_for_me") asked = e.move;
  }
  ASSERT_FALSE(asked.empty());
  const Position before = play.position();
  const Position meant = after(play.rules(), before, *read_move(play.rules(), before, asked));
  MoveList legal;
  generate(play.rules(), before, legal);
  const auto other_move = std::find_if(legal.begin(), legal.end(),
                                       [&](const Move& move) { return !(after(play.rules(), before, move) == meant); });
  ASSERT_NE(other_move, legal.end());
  play.put(after(play.rules(), before, *other_move));
  ASSERT_TRUE(play.until(EventKind::illegal_move, 200));
  EXPECT_EQ(play.events.back().code, "not_as_asked");
  EXPECT_TRUE(play.game.board_state().moves.empty());
  // Put right by making the one that was meant.
  play.put(meant);
  ASSERT_TRUE(play.until(EventKind::move, 200));
  EXPECT_EQ(play.game.board_state().moves, std::vector<std::string>{asked});
}

TEST(Game, with_all_pieces_real_what_was_captured_must_be_taken_off) {
  Play play(both_real("B:W28,48:B22,1"), 1);
  play.player_acts = false;
  ASSERT_TRUE(play.until(EventKind::turn));
  Position half = play.position();
  half.dark = (half.dark & ~square_mask(22, 10)) | square_mask(33, 10);
  play.put(half);
  ASSERT_TRUE(play.until(EventKind::illegal_move, 200));
  EXPECT_EQ(play.events.back().code, "captured_left_on_board");
  EXPECT_EQ(play.events.back().squares, std::vector<int>{28});
  half.light &= ~square_mask(28, 10);
  play.put(half);
  ASSERT_TRUE(play.until(EventKind::move, 200));
  EXPECT_EQ(play.game.board_state().moves, std::vector<std::string>{"22x33"});
}

TEST(Game, with_all_pieces_real_a_piece_of_the_other_colour_is_not_the_same) {
  Play play(both_real("B:W48:B22,1"), 1);
  play.player_acts = false;
  ASSERT_TRUE(play.until(EventKind::turn));
  Position changed = play.position();
  changed.dark &= ~square_mask(1, 10);
  changed.light |= square_mask(1, 10);
  play.put(changed);
  ASSERT_TRUE(play.until(EventKind::illegal_move, 200));
  EXPECT_TRUE(play.game.board_state().moves.empty());
}

TEST(Game, two_runs_are_equal) {
  Play a(options_from(), 11);
  Play b(options_from(), 11);
  for (int i = 0; i < 3000; ++i) {
    a.step();
    b.step();
  }
  EXPECT_EQ(a.log, b.log);
  EXPECT_EQ(a.game.save(), b.game.save());
  EXPECT_EQ(a.game.pdn(), b.game.pdn());
}

TEST(Game, waits_for_the_set_up_and_says_what_is_wrong) {
  Play play(options_from(), 1);
  play.player_acts = false;
  const Bits right = play.table.pieces;
  play.table.pieces = right & ~square_mask(7, 10);
  ASSERT_TRUE(play.until(EventKind::set_up_wrong));
  EXPECT_EQ(play.events.back().squares, std::vector<int>{7});
  EXPECT_EQ(play.game.board_state().phase, GamePhase::setting_up);
  play.put(right);
  ASSERT_TRUE(play.until(EventKind::game_started));
}

TEST(Game, a_board_turned_round_is_noticed) {
  Play play(options_from(), 1);
  play.table.pieces = start_position(play.rules()).light;
  ASSERT_TRUE(play.until(EventKind::set_up_wrong));
  EXPECT_EQ(play.events.back().code, "board_turned");
}

// The real player's pieces after the virtual player's first move.
void reach_real_turn(Play& play) {
  play.player_acts = false;
  while (play.game.board_state().phase != GamePhase::real_to_move) {
    play.step();
    ASSERT_LT(play.frame, 2000);
  }
}

// He moves while the board goes out of the picture and, when it comes back, half of it cannot be told yet: time in
// which nobody looked says nothing about what stands there, and a piece seen on its new square is no piece too many
// while its old square is not seen.
TEST(Game, a_move_made_as_the_board_leaves_the_picture_is_not_called_wrong) {
  Play play(options_from(), 5);
  reach_real_turn(play);
  // 17-22: its old square is among those that cannot be told, the new one is not.
  play.table.pieces = (play.table.pieces & ~square_mask(17, 10)) | square_mask(22, 10);
  Occupancy half_seen = play.table.seen(play.frame, false);
  for (int row = 0; row < 10; ++row)
    for (int col = 0; col < 3; ++col)
      half_seen.cells[static_cast<std::size_t>(row * 10 + col)].reading = CellReading::unknown;
  const auto look = [&](const std::optional<Occupancy>& sight) {
    GameInputs in;
    in.now_ns = play.frame++ * frame_ns;
    in.sight = sight;
    return play.game.step(in).events;
  };
  EXPECT_TRUE(look(half_seen).empty());
  for (int i = 0; i < 60; ++i) EXPECT_TRUE(look(std::nullopt).empty());
  EXPECT_TRUE(look(half_seen).empty()) << "one look after a long absence";
  int unclear = 0;
  for (int i = 0; i < 60; ++i)
    for (const GameEvent& event : look(half_seen)) {
      EXPECT_EQ(event.kind, EventKind::board_unclear);
      ++unclear;
    }
  EXPECT_EQ(unclear, 1);
  for (int i = 0; i < 8; ++i) look(play.table.seen(play.frame, false));
  EXPECT_EQ(play.game.board_state().moves.back(), "17-22");
}

// Two of his pieces moved, which is objected to; then the squares of one of them cannot be told. What is left looks
// like a legal move.
TEST(Game, what_was_wrong_and_is_out_of_sight_is_not_forgiven) {
  Play play(options_from(), 5);
  reach_real_turn(play);
  const Bits before = play.table.pieces;
  play.put((before & ~square_mask(18, 10) & ~square_mask(20, 10)) | square_mask(23, 10) | square_mask(25, 10));
  ASSERT_TRUE(play.until(EventKind::illegal_move));
  EXPECT_EQ(play.events.back().code, "two_pieces_moved");
  const auto look_without = [&](const std::vector<int>& hidden) {
    Occupancy seen = play.table.seen(play.frame, false);
    for (const int square : hidden) {
      const Cell cell = cell_of_square(square, 10);
      seen.cells[static_cast<std::size_t>(cell.row * 10 + cell.col)].reading = CellReading::unknown;
    }
    GameInputs in;
    in.now_ns = play.frame++ * frame_ns;
    in.sight = seen;
    return play.game.step(in).events;
  };
  for (int i = 0; i < 60; ++i)
    for (const GameEvent& event : look_without({20, 25})) EXPECT_NE(event.kind, EventKind::move) << event.move;
  EXPECT_EQ(play.game.board_state().phase, GamePhase::illegal);
  // The second piece is put back, and all is seen: the move counts.
  play.table.pieces = (before & ~square_mask(18, 10)) | square_mask(23, 10);
  for (int i = 0; i < 10; ++i) look_without({});
  EXPECT_EQ(play.game.board_state().moves.back(), "18-23");
}

TEST(Game, a_move_counts_only_when_nearly_the_whole_board_is_seen) {
  Play play(options_from(), 5);
  reach_real_turn(play);
  play.table.pieces = (play.table.pieces & ~square_mask(18, 10)) | square_mask(23, 10);
  const auto look = [&](int unseen_columns) {
    Occupancy seen = play.table.seen(play.frame, false);
    for (int row = 0; row < 10; ++row)
      for (int col = 0; col < unseen_columns; ++col)
        seen.cells[static_cast<std::size_t>(row * 10 + col)].reading = CellReading::unknown;
    GameInputs in;
    in.now_ns = play.frame++ * frame_ns;
    in.sight = seen;
    return play.game.step(in).events;
  };
  for (int i = 0; i < 60; ++i)
    for (const GameEvent& event : look(3)) EXPECT_EQ(event.kind, EventKind::board_unclear);
  for (int i = 0; i < 10; ++i) look(1);
  EXPECT_EQ(play.game.board_state().moves.back(), "18-23");
}

// Some squares can be told in one picture and not in the next; none is ever read wrongly.
TEST(Game, squares_that_flicker_keep_nobody_waiting) {
  Play play(options_from(), 1);
  std::uint64_t random = 5;
  const auto look = [&] {
    Occupancy seen = play.table.seen(play.frame, false);
    for (const int square : {22, 31, 37, 44}) {
      const Cell cell = cell_of_square(square, 10);
      if (simulated::next_random(random) % 2 == 0)
        seen.cells[static_cast<std::size_t>(cell.row * 10 + cell.col)].reading = CellReading::unknown;
    }
    GameInputs in;
    in.now_ns = play.frame++ * frame_ns;
    in.sight = seen;
    return play.game.step(in).events;
  };
  bool started = false;
  for (int i = 0; i < 40; ++i)
    for (const GameEvent& event : look()) started = started || event.kind == EventKind::game_started;
  EXPECT_TRUE(started);
  // An illegal position is objected to once, not anew with every flicker.
  play.table.pieces &= ~square_mask(20, 10);
  int objections = 0;
  for (int i = 0; i < 100; ++i)
    for (const GameEvent& event : look()) objections += event.kind == EventKind::illegal_move;
  EXPECT_EQ(objections, 1);
}

TEST(Game, an_illegal_move_is_named_and_put_back) {
  Play play(options_from(), 5);
  reach_real_turn(play);
  const Bits right = play.table.pieces;
  play.put((right & ~square_mask(18, 10)) | square_mask(27, 10));
  ASSERT_TRUE(play.until(EventKind::illegal_move));
  const GameEvent wrong = play.events.back();
  EXPECT_EQ(wrong.code, "moved_too_far");
  EXPECT_EQ(wrong.squares, (std::vector<int>{18, 27}));
  ASSERT_FALSE(wrong.legal.empty());
  EXPECT_TRUE(read_move(play.rules(), play.position(), wrong.legal.front()));
  EXPECT_EQ(play.game.board_state().phase, GamePhase::illegal);
  EXPECT_EQ(play.game.board_state().moves.size(), 1u);
  play.put(right);
  ASSERT_TRUE(play.until(EventKind::board_restored));
  EXPECT_EQ(play.game.board_state().phase, GamePhase::real_to_move);
}

TEST(Game, an_illegal_move_may_be_followed_by_a_legal_one) {
  Play play(options_from(), 5);
  reach_real_turn(play);
  const Bits right = play.table.pieces;
  play.put((right & ~square_mask(18, 10)) | square_mask(27, 10));
  ASSERT_TRUE(play.until(EventKind::illegal_move));
  play.put((right & ~square_mask(16, 10)) | square_mask(21, 10));
  ASSERT_TRUE(play.until(EventKind::move));
  EXPECT_EQ(play.events[play.events.size() - 2].move, "16-21");
  EXPECT_EQ(play.count(EventKind::board_restored), 1);
}

TEST(Game, a_hand_over_the_board_is_no_move) {
  Play play(options_from(), 5);
  reach_real_turn(play);
  const std::size_t before = play.events.size();
  play.put(play.table.pieces, 200);
  for (int i = 0; i < 220; ++i) play.step();
  EXPECT_EQ(play.events.size(), before);
}

TEST(Game, a_move_is_recognised_soon_after_the_hand_is_away) {
  Play play(options_from(), 5);
  reach_real_turn(play);
  play.put((play.table.pieces & ~square_mask(16, 10)) | square_mask(21, 10), 10);
  while (play.hand_is_over) play.step();
  const std::int64_t away = play.frame;
  ASSERT_TRUE(play.until(EventKind::move));
  EXPECT_LE((play.frame - away) * frame_ns, 400'000'000);
}

TEST(Game, a_piece_on_a_light_square_is_named) {
  Play play(options_from(), 5);
  reach_real_turn(play);
  play.table.pieces &= ~square_mask(20, 10);
  play.table.strays = {{4, 8}};
  ASSERT_TRUE(play.until(EventKind::illegal_move));
  EXPECT_EQ(play.events.back().code, "light_square");
}

TEST(Game, a_real_piece_cannot_land_on_a_virtual_one) {
  Play play(options_from("B:W27,45:B22,7"), 5);
  play.player_acts = false;
  ASSERT_TRUE(play.until(EventKind::turn));
  play.put(square_mask(27, 10) | square_mask(7, 10));
  ASSERT_TRUE(play.until(EventKind::illegal_move));
  EXPECT_EQ(play.game.board_state().phase, GamePhase::illegal);
}

TEST(Game, captured_virtual_pieces_leave_the_screen) {
  Play play(options_from("B:W28,45:B22,7"), 5);
  play.player_acts = false;
  ASSERT_TRUE(play.until(EventKind::turn));
  play.put(square_mask(33, 10) | square_mask(7, 10));
  ASSERT_TRUE(play.until(EventKind::captured));
  EXPECT_EQ(play.events[play.events.size() - 2].captured, std::vector<int>{28});
  EXPECT_EQ(play.renderer.drawn(play.options.board), square_mask(45, 10));
}

TEST(Game, waits_until_captured_real_pieces_are_off) {
  Play play(options_from("W:W28,45:B22,7"), 5);
  play.player_acts = false;
  play.player_removes = false;
  ASSERT_TRUE(play.until(EventKind::waiting_for_removal));
  EXPECT_EQ(play.game.board_state().to_remove, std::vector<int>{22});
  for (int i = 0; i < 600; ++i) play.step();  // reminded, but nothing else happens
  EXPECT_EQ(play.game.board_state().phase, GamePhase::waiting_for_removal);
  play.player_removes = true;
  ASSERT_TRUE(play.until(EventKind::removal_done));
  EXPECT_EQ(play.game.board_state().phase, GamePhase::real_to_move);
}

TEST(Game, removing_and_moving_at_once_is_understood) {
  Play play(options_from("W:W28,45:B22,7"), 5);
  play.player_acts = false;
  play.player_removes = false;
  ASSERT_TRUE(play.until(EventKind::waiting_for_removal));  // 28x17 or 28x... took 22
  MoveList legal;
  generate(play.rules(), play.position(), legal);
  play.put((play.position().dark & ~one(legal[0].from)) | one(legal[0].to));
  ASSERT_TRUE(play.until(EventKind::move));
  EXPECT_EQ(play.count(EventKind::removal_done), 1);
  EXPECT_EQ(play.count(EventKind::illegal_move), 0);
}

TEST(Game, the_wrong_piece_taken_off_is_named) {
  Play play(options_from("W:W28,45:B22,7,8"), 5);
  play.player_acts = false;
  play.player_removes = false;
  ASSERT_TRUE(play.until(EventKind::waiting_for_removal));
  play.put(square_mask(22, 10) | square_mask(8, 10));
  ASSERT_TRUE(play.until(EventKind::illegal_move));
  EXPECT_EQ(play.events.back().code, "extra_piece_removed");
  EXPECT_EQ(play.events.back().squares, std::vector<int>{7});
}

TEST(Game, what_the_virtual_player_loses_he_takes_off_and_crowns_his_king_with) {
  Play play(options_from("B:W7,28:B16,22"), 5);
  std::vector<std::pair<std::string, Point3>> all;  // every piece that a hand was told to take, and where to
  for (int frame = 0; frame < 400; ++frame) {
    for (const Command& command : play.step().commands) {
      const auto* grasp = std::get_if<Grasp>(&command.action);
      if (grasp != nullptr && !grasp->piece.empty()) all.emplace_back(grasp->piece, grasp->path_B.back());
    }
    play.player_acts = play.player_acts && play.position().turn == Side::dark;
  }
  ASSERT_EQ(all.size(), 3u) << "the lost man, the move, the crown";
  const Point3 beside = place_beside_board_B(play.options.board, Side::light, 0);
  EXPECT_EQ(all[0], (std::pair<std::string, Point3>("light_28", beside)));
  EXPECT_FALSE(cell_at_B(beside, play.options.board));
  EXPECT_EQ(all[1].first, "light_7") << "he moves when his hands are free again";
  EXPECT_EQ(all[2].first, "light_28");
  EXPECT_NEAR(all[2].second[0], all[1].second[0], 1e-9) << "on top of the man";
  EXPECT_NEAR(all[2].second[1], all[1].second[1], 1e-9);
  EXPECT_NEAR(all[2].second[2], play.options.board.piece_height_m, 1e-9);
  EXPECT_EQ(play.renderer.pieces.size(), 1u) << "in the end there is a king, and nothing beside the board";
  EXPECT_EQ(play.renderer.pieces.count("light_7"), 1u);
  EXPECT_EQ(play.renderer.kings, 1);
}

TEST(Game, a_king_without_lost_men_is_crowned_without_hands) {
  Play play(options_from("W:W7,38:B26,46"), 5);
  play.player_acts = false;
  play.player_removes = false;
  ASSERT_TRUE(play.until(EventKind::move));
  for (int i = 0; i < 60; ++i) play.step();
  for (const auto& [name, p_B] : play.renderer.pieces) EXPECT_NEAR(p_B[2], 0, 1e-9) << name;
}

TEST(Game, a_captured_king_lies_beside_the_board_as_two_pieces) {
  LostPieces lost(BoardGeometry{}, Side::light);
  lost.capture("light_31", true, 22);
  for (LostPiece& piece : lost.all()) {
    if (std::exchange(piece.to_carry, false)) piece.grasp = 7;
  }
  std::vector<ScenePiece> shown;
  lost.show(shown);
  ASSERT_EQ(shown.size(), 1u) << "still a king on its square";
  EXPECT_TRUE(shown[0].king);
  EXPECT_EQ(shown[0].p_B, centre_of_square_B(22, BoardGeometry{}));
  EXPECT_TRUE(lost.ended(7));
  EXPECT_FALSE(lost.ended(7));
  shown.clear();
  lost.show(shown);
  ASSERT_EQ(shown.size(), 2u);
  EXPECT_FALSE(shown[0].king || shown[1].king);
  EXPECT_NEAR(shown[1].p_B[2] - shown[0].p_B[2], BoardGeometry{}.piece_height_m, 1e-9);
  lost.crown("light_35", 3);
  lost.settle();
  shown.clear();
  lost.show(shown);
  ASSERT_EQ(shown.size(), 1u) << "the upper one is on the new king";
  EXPECT_EQ(shown[0].name, "light_31");
}

TEST(Game, a_failed_grasp_is_tried_again_and_then_the_piece_is_set) {
  for (const int failures : {1, 2}) {
    Play play(options_from(), 5);
    play.renderer.fail_grasps = failures;
    ASSERT_TRUE(play.until(EventKind::move)) << failures;
    play.step();
    EXPECT_EQ(play.renderer.drawn(play.options.board), play.position().light);
    ASSERT_TRUE(play.until(EventKind::turn));
    expect_sound(play);
  }
}

TEST(Game, a_fresh_renderer_gets_everything_again) {
  Play play(options_from(), 5);
  ASSERT_TRUE(play.until(EventKind::turn));
  while (play.thinking_about || play.renderer.running.empty()) play.step();
  for (int i = 0; i < 3; ++i) play.step();
  play.renderer.running.clear();  // killed in the middle of a grasp
  play.renderer.pieces.clear();
  play.join = true;
  ASSERT_TRUE(play.until(EventKind::move));
  play.step();
  EXPECT_EQ(play.renderer.drawn(play.options.board), play.position().light);
  EXPECT_TRUE(play.renderer.ids_grow);
  ASSERT_TRUE(play.until(EventKind::game_over, 40'000));
  EXPECT_EQ(play.moves_drawn_right, play.count(EventKind::turn));
}

TEST(Game, goes_on_after_this_process_was_killed_at_any_time) {
  for (const int killed_at : {5, 30, 47, 60, 75, 90, 123, 200, 333, 512, 700}) {
    Play play(options_from(), 5);
    for (int i = 0; i < killed_at; ++i) play.step();
    const std::string saved = play.game.save();
    const std::uint64_t last_id = play.renderer.last_id;
    auto resumed = Game::resume(play.options, saved);
    ASSERT_TRUE(resumed) << resumed.error().message;
    EXPECT_EQ(resumed->board_state().moves, play.game.board_state().moves);
    play.game = std::move(*resumed);
    play.thinking_about.reset();
    play.renderer.running.clear();
    play.join = true;
    ASSERT_TRUE(play.until(EventKind::game_over, 40'000)) << killed_at;
    expect_sound(play);
    EXPECT_TRUE(play.renderer.ids_grow);
    EXPECT_GT(play.renderer.last_id, last_id);
  }
}

TEST(Game, damaged_saves_are_refused_with_a_sentence) {
  Play play(options_from(), 5);
  ASSERT_TRUE(play.until(EventKind::turn));
  const std::string saved = play.game.save();
  EXPECT_FALSE(Game::resume(play.options, ""));
  EXPECT_FALSE(Game::resume(play.options, "{}"));
  EXPECT_FALSE(Game::resume(play.options, saved.substr(0, saved.size() / 2)));
  std::string other = saved;
  other.replace(other.find("\"phase\":"), 9, "\"phase\":9");
  EXPECT_FALSE(Game::resume(play.options, other));
}

TEST(Game, undo_waits_for_the_board_and_goes_on) {
  Play play(options_from(), 5);
  for (int turns = 0; turns < 5; ++turns) ASSERT_TRUE(play.until(EventKind::turn));
  const std::size_t moves = play.game.board_state().moves.size();
  play.player_acts = false;
  while (play.game.board_state().phase != GamePhase::real_to_move) play.step();
  Control undo;
  undo.kind = ControlKind::undo;
  play.controls = {undo};
  ASSERT_TRUE(play.until(EventKind::undone));
  EXPECT_LT(play.game.board_state().moves.size(), moves);
  EXPECT_EQ(play.position().turn, Side::dark);
  EXPECT_EQ(play.game.board_state().phase, GamePhase::setting_up);
  play.put(play.position().dark);
  ASSERT_TRUE(play.until(EventKind::board_restored));
  EXPECT_EQ(play.game.board_state().phase, GamePhase::real_to_move);
  play.player_acts = true;
  ASSERT_TRUE(play.until(EventKind::game_over, 40'000));
  expect_sound(play);
}

TEST(Game, pause_ignores_the_board_and_resume_goes_on) {
  Play play(options_from(), 5);
  reach_real_turn(play);
  Control control;
  control.kind = ControlKind::pause;
  play.controls = {control};
  play.step();
  EXPECT_EQ(play.game.board_state().phase, GamePhase::paused);
  play.put(0);
  for (int i = 0; i < 100; ++i) play.step();
  EXPECT_EQ(play.count(EventKind::illegal_move), 0);
  control.kind = ControlKind::resume;
  play.controls = {control};
  ASSERT_TRUE(play.until(EventKind::illegal_move));
}

TEST(Game, resigning_ends_the_game) {
  Play play(options_from(), 5);
  reach_real_turn(play);
  Control control;
  control.kind = ControlKind::resign;
  play.controls = {control};
  ASSERT_TRUE(play.until(EventKind::game_over));
  EXPECT_EQ(play.game.board_state().result, GameResult::light_wins);
  EXPECT_EQ(play.events.back().code, "resigned");
  EXPECT_NE(play.game.pdn().find("[Result \"2-0\"]"), std::string::npos);
}

TEST(Game, controls_that_cannot_be_obeyed_are_answered) {
  Play play(options_from(), 5);
  play.step();
  Control undo;
  undo.kind = ControlKind::undo;
  Control fresh;
  fresh.kind = ControlKind::new_game;
  fresh.text = "nonsense";
  play.controls = {undo, fresh};
  EXPECT_EQ(play.step().rejected.size(), 2u);
}

TEST(Game, the_move_may_be_named) {
  Play play(options_from(), 5);
  reach_real_turn(play);
  Control control;
  control.kind = ControlKind::it_was;
  control.text = "20-25";
  play.controls = {control};
  play.table.pieces = (play.table.pieces & ~square_mask(20, 10)) | square_mask(25, 10);
  ASSERT_TRUE(play.until(EventKind::move));
  EXPECT_EQ(play.game.board_state().moves.back(), "20-25");
}

// The king on 21 can capture by way of 38 and 24 or of 49 and 35; both end on 2, with other pieces taken.
TEST(Game, an_ambiguous_capture_is_resolved_by_what_was_seen_on_the_way) {
  const std::string fen = "B:W8,17,29,32,39,40:B4,K21,34";
  const Position p = *read_fen(international_rules, fen);
  MoveList legal;
  generate(international_rules, p, legal);
  ASSERT_EQ(legal.size(), 2);
  ASSERT_EQ(legal[0].to, legal[1].to);
  const Bits others = square_mask(4, 10) | square_mask(34, 10);
  const Bits end = others | one(legal[0].to);
  for (const Move& move : {legal[0], legal[1]}) {
    Play play(options_from(fen), 5);
    play.player_acts = false;
    ASSERT_TRUE(play.until(EventKind::turn));
    const int via = routes(international_rules, p, move).front().squares[1];
    play.put(square_mask(via, 10) | others);
    for (int i = 0; i < 12; ++i) play.step();
    play.put(end);
    ASSERT_TRUE(play.until(EventKind::move));
    EXPECT_EQ(play.game.board_state().moves.back(), path_text(international_rules, p, move));
  }
  Play play(options_from(fen), 5);
  play.player_acts = false;
  ASSERT_TRUE(play.until(EventKind::turn));
  play.put(end);
  ASSERT_TRUE(play.until(EventKind::board_unclear));
  EXPECT_EQ(play.events.back().code, "which_capture");
  EXPECT_EQ(play.events.back().legal.size(), 2u);
  // Asked, the player says so.
  Control control;
  control.kind = ControlKind::it_was;
  control.text = play.events.back().legal.back();
  play.controls = {control};
  ASSERT_TRUE(play.until(EventKind::move));
}

TEST(Game, bad_options_are_refused) {
  GameOptions options;
  options.rules = "chess";
  EXPECT_FALSE(Game::start(options));
  options = options_from("W:W99:B1");
  EXPECT_FALSE(Game::start(options));
  options = {};
  options.board.squares = 8;
  EXPECT_FALSE(Game::start(options));
}

}  // namespace
}  // namespace counterpart
