#include "game_controller/engine/endgame.hpp"

#include <cstdio>

#include <gtest/gtest.h>

#include "game_controller/engine/search.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

const EndgameTables& tables() {
  static const EndgameTables made = EndgameTables::generate();
  return made;
}

EndgameValue value_of(const char* fen) {
  return tables().find(*read_fen(international_rules, fen)).value_or(EndgameValue{9, 9});
}

// Worked out by hand.
void have_the_exact_distance() {
  const struct {
    const char* fen;
    int outcome;
    int plies;
  } known[] = {
      {"W:W28:B23", 1, 1},     // takes
      {"W:WK46:BK5", -1, 2},   // must step onto the long diagonal in front of the other king
      {"W:W31:B16", 1, 3},     // 31-26 and the man on 16 must step beside it
      {"B:WK1,K2:B45", 0, 0},  // crowns
      {"W:W6:B45", 0, 0},      // both crown
  };
  for (const auto& [fen, outcome, plies] : known) {
    EXPECT_EQ(value_of(fen).outcome, outcome) << fen;
    EXPECT_EQ(value_of(fen).plies, plies) << fen;
  }
  EXPECT_FALSE(tables().find(*read_fen(international_rules, "W:W31,32:B1,2")));
  EXPECT_FALSE(tables().find(*read_fen(international_rules, "W:W31,32:B")));
}

// What makes a table right: each value follows from those after the moves.
void every_value_follows_from_the_next_ones() {
  std::uint64_t random = 3;
  const auto roll = [&](int sides) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    return static_cast<int>((random >> 33) % static_cast<std::uint64_t>(sides));
  };
  int wins = 0;
  for (int n = 0; n < 20'000; ++n) {
    Position p;
    p.turn = roll(2) == 0 ? Side::light : Side::dark;
    for (int i = 0; i < 3; ++i) {
      const int square = 6 + roll(40);
      const Bits bit = square_mask(square, 10);
      if (((p.light | p.dark) & bit) != 0) continue;
      (i == 0 ? p.light : i == 1 ? p.dark : roll(2) == 0 ? p.light : p.dark) |= bit;
      if (roll(2) == 0) p.kings |= bit;
    }
    const auto value = tables().find(p);
    if (!value) continue;
    MoveList moves;
    generate(international_rules, p, moves);
    int fastest_win = 1'000;
    int slowest_loss = moves.empty() ? 0 : -1;
    bool all_lose = true;
    for (const Move& move : moves) {
      const Position q = after(international_rules, p, move);
      const bool over = (p.turn == Side::light ? q.dark : q.light) == 0;
      const EndgameValue then = over ? EndgameValue{-1, 0} : *tables().find(q);
      if (then.outcome < 0) fastest_win = std::min(fastest_win, then.plies + 1);
      if (then.outcome > 0) slowest_loss = std::max(slowest_loss, then.plies + 1);
      all_lose = all_lose && then.outcome > 0;
    }
    const int outcome = fastest_win < 1'000 ? 1 : all_lose ? -1 : 0;
    ASSERT_EQ(value->outcome, outcome) << write_fen(international_rules, p);
    ASSERT_EQ(value->plies, outcome > 0 ? fastest_win : outcome < 0 ? slowest_loss : 0);
    wins += outcome > 0 ? 1 : 0;
  }
  EXPECT_GT(wins, 1'000);
}

void make_the_search_see_the_end_at_once() {
  Searcher searcher(international_rules, Evaluation::trained, 1 << 20);
  searcher.use_endgames(&tables());
  SearchLimits limits;
  limits.depth = 1;
  const auto report = searcher.search(*read_fen(international_rules, "W:WK1,K2:B45"), {}, limits);
  EXPECT_EQ(report.value, win_value - value_of("W:WK1,K2:B45").plies);
}

void are_read_as_saved_and_refused_if_damaged() {
  const std::string file = ::testing::TempDir() + "counterpart_test.endgames";
  ASSERT_TRUE(tables().save(file));
  const auto read = EndgameTables::load(file);
  ASSERT_TRUE(read);
  const auto p = *read_fen(international_rules, "W:WK1,K2:B45");
  EXPECT_EQ(read->find(p)->plies, tables().find(p)->plies);
  std::FILE* f = std::fopen(file.c_str(), "ab");
  std::fputc(0, f);
  std::fclose(f);
  EXPECT_FALSE(EndgameTables::load(file));
  std::remove(file.c_str());
  EXPECT_FALSE(EndgameTables::load(file));
}

// One case: making the tables takes seconds.
TEST(Endgames, are_exact_used_and_kept) {
  have_the_exact_distance();
  every_value_follows_from_the_next_ones();
  make_the_search_see_the_end_at_once();
  are_read_as_saved_and_refused_if_damaged();
}

}  // namespace
}  // namespace counterpart
