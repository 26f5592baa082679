#include "game_controller/engine/endgame.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "game_controller/engine/endgame_cache.hpp"
#include "game_controller/engine/search.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

constexpr Material three_kings_against_one{0, 3, 0, 1};

// Three pieces, and what three kings against one lead to.
const EndgameTables& tables() {
  static EndgameTables made(international_rules);
  for (const Material& m : endgame_materials(3)) made.make(m);
  made.make(three_kings_against_one);
  return made;
}

EndgameValue value_of(const char* fen) {
  return tables().find(*read_fen(international_rules, fen)).value_or(EndgameValue{9, 9});
}

struct Count {
  int wins = 0;
  int losses = 0;
  int neither = 0;
  int longest_win_plies = 0;
};

Count count_of(const EndgameTables& tables, const Material& material) {
  Count count;
  for (const int value : *tables.bytes(material)) {
    if (value == 0) {
      ++count.neither;
    } else if (value % 2 == 0) {
      ++count.wins;
      count.longest_win_plies = std::max(count.longest_win_plies, value - 1);
    } else {
      ++count.losses;
    }
  }
  return count;
}

// Ed Trice's table of the English endgame of a king against a king: "TOTAL WINS (white to move) 230, DRAWS 654,
// LOSSES 108; the longest win requires 11 ply" (damforum.nl, viewtopic.php?t=2603). He counts 992 positions; our table
// has 32 more bytes, for two pieces on one square.
TEST(Endgames, are_the_published_ones_of_english_kings) {
  EndgameTables english(english_rules);
  english.make({0, 1, 0, 1});
  const Count count = count_of(english, {0, 1, 0, 1});
  EXPECT_EQ(count.wins, 230);
  EXPECT_EQ(count.losses, 108);
  EXPECT_EQ(count.neither, 654 + 32);
  EXPECT_EQ(count.longest_win_plies, 11);
}

// Petrov's triangle (A. D. Petrov 1827; P. R. Montero 1591): on the board of 64 squares three kings that hold the main
// road catch a lone king wherever it stands, in the thirteenth move at the latest; they need not when it holds the
// road.
TEST(Endgames, are_petrovs_triangle) {
  EndgameTables brazilian(brazilian_rules);
  brazilian.make(three_kings_against_one);
  Bits main_road = 0;
  for (const int square : {4, 8, 11, 15, 18, 22, 25, 29}) main_road |= square_mask(square, 8);
  int longest_plies = 0;
  int without_road = 0;
  int without_road_not_won = 0;
  const auto look_at = [&](const Position& p) {
    Position passed = p;
    passed.turn = Side::dark;
    if (can_capture(brazilian_rules, passed)) return;  // three kings are not three for long
    const EndgameValue value = brazilian.find(p).value();
    if ((p.light & main_road) != 0) {
      ASSERT_EQ(value.outcome, 1) << write_fen(brazilian_rules, p);
      longest_plies = std::max(longest_plies, value.plies);
    } else if ((p.dark & main_road) != 0) {
      ++without_road;
      without_road_not_won += value.outcome == 1 ? 0 : 1;
    }
  };
  for (int a = 1; a <= 32; ++a) {
    for (int b = a + 1; b <= 32; ++b) {
      for (int c = b + 1; c <= 32; ++c) {
        for (int lone = 1; lone <= 32; ++lone) {
          if (lone == a || lone == b || lone == c) continue;
          Position p;
          p.light = square_mask(a, 8) | square_mask(b, 8) | square_mask(c, 8);
          p.dark = square_mask(lone, 8);
          p.kings = p.light | p.dark;
          look_at(p);
        }
      }
    }
  }
  EXPECT_EQ((longest_plies + 1) / 2, 13);
  EXPECT_GT(without_road_not_won, without_road / 2);
}

// What the tables foretell is what happens when both sides play by them, within the sixteen moves that the rules allow.
TEST(Endgames, are_played_out_in_the_foretold_number_of_plies) {
  Searcher searcher(international_rules, Evaluation::trained, 1 << 20);
  searcher.use_endgames(&tables());
  for (const char* fen : {"W:WK1,K7,K18:BK35", "W:WK1,K2:B45", "W:W31:B16"}) {
    Position p = *read_fen(international_rules, fen);
    const EndgameValue foretold = value_of(fen);
    ASSERT_EQ(foretold.outcome, 1) << fen;
    int plies = 0;
    SearchLimits limits;
    limits.depth = 2;
    for (; has_move(international_rules, p) && plies <= foretold.plies; ++plies) {
      p = after(international_rules, p, searcher.search(p, {}, limits).line.front());
    }
    EXPECT_EQ(plies, foretold.plies) << fen;
    EXPECT_EQ(p.turn, Side::dark) << fen;
  }
}

// Worked out by hand.
TEST(Endgames, have_the_exact_distance) {
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
  EXPECT_FALSE(tables().find(*read_fen(international_rules, "W:W31,32:B1,2")));  // not made here
  EXPECT_FALSE(tables().find(*read_fen(international_rules, "W:W31,32:B")));
}

// What makes a table right: each value follows from those after the moves.
void expect_each_value_to_follow(const std::function<Position(const std::function<int(int)>&)>& random_position) {
  std::uint64_t random = 3;
  const auto roll = [&](int sides) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    return static_cast<int>((random >> 33) % static_cast<std::uint64_t>(sides));
  };
  int wins = 0;
  for (int n = 0; n < 20'000; ++n) {
    const Position p = random_position(roll);
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

TEST(Endgames, follow_from_each_other_with_three_pieces) {
  expect_each_value_to_follow([](const auto& roll) {
    Position p;
    p.turn = roll(2) == 0 ? Side::light : Side::dark;
    for (int i = 0; i < 3; ++i) {
      const Bits bit = square_mask(6 + roll(40), 10);  // where men of both sides may stand
      if (((p.light | p.dark) & bit) != 0) continue;
      (i == 0 ? p.light : i == 1 ? p.dark : roll(2) == 0 ? p.light : p.dark) |= bit;
      if (roll(2) == 0) p.kings |= bit;
    }
    return p;
  });
}

TEST(Endgames, follow_from_each_other_with_four_kings) {
  expect_each_value_to_follow([](const auto& roll) {
    Position p;
    p.turn = roll(2) == 0 ? Side::light : Side::dark;
    for (int i = 0; i < 4; ++i) {
      const Bits bit = square_mask(1 + roll(50), 10);
      if (((p.light | p.dark) & bit) == 0) (i == 0 ? p.dark : p.light) |= bit;
    }
    p.kings = p.light | p.dark;
    return p;
  });
}

TEST(Endgames, make_the_search_see_the_end_at_once) {
  Searcher searcher(international_rules, Evaluation::trained, 1 << 20);
  searcher.use_endgames(&tables());
  SearchLimits limits;
  limits.depth = 1;
  const auto report = searcher.search(*read_fen(international_rules, "W:WK1,K2:B45"), {}, limits);
  EXPECT_EQ(report.value, win_value - value_of("W:WK1,K2:B45").plies);
}

std::filesystem::path fresh_folder(const char* name) {
  const auto folder = std::filesystem::path(::testing::TempDir()) / name;
  std::filesystem::remove_all(folder);
  return folder;
}

TEST(EndgameCache, keeps_what_was_made_and_makes_again_what_is_damaged) {
  const auto folder = fresh_folder("counterpart_endgames_kept");
  const Material two_kings_against_one{0, 2, 0, 1};
  {
    EndgameCache cache(international_rules, folder.string());
    EXPECT_FALSE(cache.tables().has(two_kings_against_one));
    cache.make(two_kings_against_one);
    EXPECT_EQ(*cache.tables().bytes(two_kings_against_one), *tables().bytes(two_kings_against_one));
  }
  EXPECT_TRUE(EndgameCache(international_rules, folder.string()).tables().has(two_kings_against_one));
  EXPECT_FALSE(EndgameCache(english_rules, folder.string()).tables().has(two_kings_against_one));
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    std::ofstream(file.path(), std::ios::app) << "?";
  }
  EXPECT_FALSE(EndgameCache(international_rules, folder.string()).tables().has(two_kings_against_one));
  std::filesystem::remove_all(folder);
}

TEST(EndgameCache, makes_them_while_they_are_read) {
  const auto folder = fresh_folder("counterpart_endgames_background");
  {
    EndgameCache cache(international_rules, folder.string());
    cache.make_in_background(2);
    const Position lost = *read_fen(international_rules, "W:WK46:BK5");
    std::optional<EndgameValue> value;
    for (int i = 0; i < 60'000 && !value; ++i) {
      value = cache.tables().find(lost);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(value);
    EXPECT_EQ(value->plies, 2);
  }
  std::filesystem::remove_all(folder);
}

// A program that ends while they are made does not wait for them.
TEST(EndgameCache, ends_at_once_in_the_middle_of_making) {
  const auto folder = fresh_folder("counterpart_endgames_cut_short");
  const auto begun = std::chrono::steady_clock::now();
  { EndgameCache(international_rules, folder.string()).make_in_background(EndgameTables::most_pieces); }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  EXPECT_LT(seconds, 10);  // making them all takes half a minute and more
  std::filesystem::remove_all(folder);
}

TEST(EndgameCache, does_without_a_folder_that_cannot_be_written) {
  EndgameCache cache(international_rules, "/proc/no/such/folder");
  cache.make({0, 1, 0, 1});
  EXPECT_TRUE(cache.tables().has({0, 1, 0, 1}));
}

}  // namespace
}  // namespace counterpart
