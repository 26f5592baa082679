#include "game_controller/engine/search.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "game_controller/engine/level.hpp"
#include "game_controller/engine/opponent.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/routes.hpp"

namespace counterpart {
namespace {

const Rules& rules = international_rules;

SearchReport searched(const std::string& fen, int depth) {
  Searcher searcher(rules, Evaluation::plain, 1 << 20);
  SearchLimits limits;
  limits.depth = depth;
  return searcher.search(*read_fen(rules, fen), {}, limits);
}

// A plain minimax with the same horizon, as the truth that pruning may not change: wins within few plies.
int plies_to_win(const Position& position, int depth) {
  MoveList moves;
  generate(rules, position, moves);
  if (moves.empty()) return 0;  // lost
  if (depth == 0) return -1;
  int best = -1;
  bool all_lose = true;
  for (const Move& move : moves) {
    const int reply = plies_to_win(after(rules, position, move), depth - 1);
    if (reply >= 0 && reply % 2 == 0 && (best < 0 || reply + 1 < best)) best = reply + 1;
    all_lose = all_lose && reply >= 0 && reply % 2 == 1;
    if (all_lose) best = std::max(best, reply + 1);
  }
  if (best >= 0 && best % 2 == 1) return best;
  if (!all_lose) return -1;
  return best;
}

TEST(Search, finds_short_wins_like_minimax) {
  for (const char* fen : {"W:WK28,K6:B16,45", "W:W33,K1:B24,35", "B:WK5,37:BK46,26,36", "W:W32,37,K20:B21,26,16"}) {
    const int plies = plies_to_win(*read_fen(rules, fen), 7);
    const SearchReport report = searched(fen, 9);
    if (plies > 0 && plies % 2 == 1) {
      EXPECT_EQ(report.value, win_value - plies) << fen;
    } else {
      EXPECT_LT(report.value, win_value - 7) << fen;
    }
  }
}

TEST(Search, the_same_search_gives_the_same_answer) {
  const SearchReport a = searched("W:W31-50:B1-20", 7);
  const SearchReport b = searched("W:W31-50:B1-20", 7);
  EXPECT_EQ(a.line, b.line);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.value, b.value);
}

TEST(Search, the_line_is_legal) {
  const SearchReport report = searched("W:W31-50:B1-20", 9);
  Position at = start_position(rules);
  for (const Move& move : report.line) {
    MoveList legal;
    generate(rules, at, legal);
    ASSERT_NE(std::find(legal.begin(), legal.end(), move), legal.end());
    at = after(rules, at, move);
  }
}

TEST(Search, stops_when_told) {
  Searcher searcher(rules, Evaluation::plain, 1 << 20);
  SearchLimits limits;
  limits.give_up = [] { return true; };
  const SearchReport report = searcher.search(start_position(rules), {}, limits);
  EXPECT_FALSE(report.line.empty());  // there is always a move
  EXPECT_LE(report.nodes, 1024u);
}

TEST(Search, has_no_move_where_there_is_none) {
  EXPECT_TRUE(searched("W:W6:B1", 5).line.empty());
}

TEST(Evaluate, is_the_same_for_both_sides) {
  const Position light = *read_fen(rules, "W:W31,33,45,K10:B12,8,3");
  Position dark;  // the board turned round with the colours exchanged
  for (const int square : squares_of_bits(light.light, 10)) dark.dark |= square_mask(51 - square, 10);
  for (const int square : squares_of_bits(light.dark, 10)) dark.light |= square_mask(51 - square, 10);
  for (const int square : squares_of_bits(light.kings, 10)) dark.kings |= square_mask(51 - square, 10);
  dark.turn = Side::dark;
  for (const Evaluation e : {Evaluation::material, Evaluation::plain}) {
    EXPECT_EQ(evaluate(rules, e, nullptr, light), evaluate(rules, e, nullptr, dark));
  }
}

std::string answer(const OpponentOptions& options, const std::string& fen) {
  auto opponent = make_opponent(options);
  EXPECT_TRUE(opponent);
  (*opponent)->think(fen);
  for (int i = 0; i < 200'000; ++i) {
    if (auto result = (*opponent)->poll()) return *result ? (*result)->move : "error: " + result->error().message;
    std::this_thread::sleep_for(std::chrono::milliseconds(options.lockstep ? 0 : 1));
  }
  return "no answer";
}

TEST(Opponent, every_level_answers_with_a_legal_move) {
  const std::string fen = "B:W27,28,32,33,37,38,42:B8,12,13,18,19,23,3";
  for (int level = 1; level <= 8; ++level) {
    OpponentOptions options;
    options.level = level;
    options.lockstep = true;
    const std::string text = answer(options, fen);
    EXPECT_TRUE(read_move(rules, *read_fen(rules, fen), text)) << level << " " << text;
    EXPECT_EQ(answer(options, fen), text) << level;
  }
}

TEST(Opponent, thinks_on_its_own_thread) {
  OpponentOptions options;
  options.level = 3;
  const std::string fen = "W:W31-50:B1-20";
  EXPECT_TRUE(read_move(rules, *read_fen(rules, fen), answer(options, fen)));
}

TEST(Opponent, a_newer_question_replaces_the_older) {
  OpponentOptions options;
  options.level = 8;
  auto opponent = make_opponent(options);
  ASSERT_TRUE(opponent);
  (*opponent)->think("W:W31-50:B1-20");
  (*opponent)->think("B:W33:B18,3");
  std::optional<Result<OpponentMove>> result;
  for (int i = 0; i < 20'000 && !result; ++i) {
    result = (*opponent)->poll();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_TRUE(result && *result);
  EXPECT_TRUE(read_move(rules, *read_fen(rules, "B:W33:B18,3"), (*result)->move));
}

TEST(Opponent, bad_questions_are_answered_with_a_sentence) {
  OpponentOptions options;
  options.lockstep = true;
  EXPECT_EQ(answer(options, "nonsense").substr(0, 6), "error:");
  EXPECT_EQ(answer(options, "W:W6:B1").substr(0, 6), "error:");
  options.level = 9;
  EXPECT_FALSE(make_opponent(options));
  options.level = 4;
  options.rules = "chess";
  EXPECT_FALSE(make_opponent(options));
}

TEST(Opponent, a_forced_recapture_is_quick) {
  EXPECT_LT(acted_thinking_s(rules, *read_fen(rules, "W:W28,50:B22")),
            acted_thinking_s(rules, *read_fen(rules, "W:W31-50:B1-20")));
}

}  // namespace
}  // namespace counterpart
