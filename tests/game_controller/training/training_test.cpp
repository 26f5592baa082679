#include <cstdio>
#include <memory>

#include <gtest/gtest.h>

#include "game_controller/engine/patterns.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/training/fit.hpp"
#include "game_controller/training/lessons_file.hpp"
#include "game_controller/training/self_play.hpp"
#include "game_controller/training/weights_file.hpp"

namespace counterpart {
namespace {

Bits turned(Bits bits) {
  Bits out = 0;
  for (; bits != 0; bits &= bits - 1) out |= one(53 - lowest(bits));
  return out;
}

// The board turned round, colours swapped.
Position turned(const Position& p) {
  return {turned(p.dark), turned(p.light), turned(p.kings), other(p.turn)};
}

std::vector<Position> random_positions() {
  std::vector<Position> positions;
  std::uint64_t random = 11;
  for (int game = 0; game < 20; ++game) {
    Position p = start_position(international_rules);
    for (int ply = 0; ply < 100; ++ply) {
      MoveList legal;
      generate(international_rules, p, legal);
      if (legal.empty()) break;
      random = random * 6364136223846793005u + 1442695040888963407u;
      p = after(international_rules, p,
                legal[static_cast<int>((random >> 33) % static_cast<std::uint64_t>(legal.size()))]);
      positions.push_back(p);
    }
  }
  return positions;
}

TEST(Patterns, have_no_favourite_side) {
  for (const Position& p : random_positions()) {
    EXPECT_EQ(pattern_value(built_in_weights(), p), -pattern_value(built_in_weights(), turned(p)));
  }
}

// Each square must be seen by some block: a man anywhere changes the states.
TEST(Patterns, cover_the_board) {
  const PatternView empty = view_patterns(Position{});
  for (int square = 1; square <= 50; ++square) {
    Position p;
    p.light = square_mask(square, 10);
    EXPECT_NE(view_patterns(p).states, empty.states) << square;
  }
}

TEST(Patterns, know_what_a_man_is_worth) {
  const auto value = [](const char* fen) {
    return pattern_value(built_in_weights(), *read_fen(international_rules, fen));
  };
  EXPECT_GT(value("W:W31-50:B1-19"), 40);
  EXPECT_LT(value("W:W32-50:B1-20"), -40);
  EXPECT_GT(value("W:WK40,45:B6,11"), 40);
}

TEST(SelfPlay, teaches_the_same_each_time) {
  SelfPlayOptions options;
  options.games = 4;
  options.depth = 2;
  const auto lessons = play_lessons(options);
  const auto again = play_lessons(options);
  ASSERT_GT(lessons.size(), 50u);
  ASSERT_EQ(lessons.size(), again.size());
  for (std::size_t i = 0; i < lessons.size(); ++i) {
    EXPECT_EQ(lessons[i].position, again[i].position);
    EXPECT_EQ(lessons[i].result, again[i].result);
    MoveList captures;
    generate_captures(international_rules, lessons[i].position, captures);
    EXPECT_TRUE(captures.empty());
  }
}

// Lessons in which the side with a man on 28 always wins, whatever else stands where: it must be learnt that this is
// good, and for the other side the square opposite, 23.
TEST(Fit, finds_what_decides) {
  std::vector<Lesson> lessons;
  int game = 0;
  for (const Position& p : random_positions()) {
    const bool light = (p.light & square_mask(28, 10)) != 0;
    const bool dark = (p.dark & square_mask(23, 10)) != 0;
    lessons.push_back({p, light == dark ? 0.5F : light ? 1.0F : 0.0F, 0, game++});
  }
  FitOptions options;
  options.trust_in_search = 0;
  options.epochs = 20;
  double first = 0;
  double last = 0;
  const PatternWeights weights = fit(lessons, options, [&](const FitProgress& p) {
    if (p.epoch == 1) first = p.held_back_loss;
    last = p.held_back_loss;
  });
  EXPECT_LT(last, 0.9 * first);
  const auto with = *read_fen(international_rules, "W:W28,36-45:B6-16");
  const auto without = *read_fen(international_rules, "W:W46,36-45:B6-16");
  EXPECT_GT(pattern_value(weights, with), pattern_value(weights, without));
}

// Played in one go or in two parts: the same lessons.
TEST(LessonsFile, is_gone_on_from_read_and_refused_if_damaged) {
  const std::string file = ::testing::TempDir() + "counterpart_test.lessons";
  std::remove(file.c_str());
  EXPECT_EQ(read_lessons(file).error().code, ErrorCode::not_found);
  SelfPlayOptions options;
  options.games = 2;
  options.depth = 2;
  const auto together = play_lessons(options);
  options.games = 1;
  for (options.first_game = 0; options.first_game < 2; ++options.first_game) {
    ASSERT_TRUE(append_lessons(play_lessons(options), file));
  }
  const auto read = read_lessons(file);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), together.size());
  for (std::size_t i = 0; i < together.size(); ++i) {
    EXPECT_EQ((*read)[i].position, together[i].position);
    EXPECT_EQ((*read)[i].result, together[i].result);
    EXPECT_EQ((*read)[i].value, together[i].value);
    EXPECT_EQ((*read)[i].game, together[i].game);
  }
  std::FILE* f = std::fopen(file.c_str(), "ab");
  for (int i = 0; i < 40; ++i) std::fputc(0xFF, f);  // as long as a lesson, but none
  std::fclose(f);
  EXPECT_EQ(read_lessons(file).error().code, ErrorCode::bad_format);
  std::remove(file.c_str());
}

TEST(WeightsFile, is_read_as_written_and_refused_if_damaged) {
  const std::string file = ::testing::TempDir() + "counterpart_test.weights";
  ASSERT_TRUE(write_weights(built_in_weights(), file));
  const auto read = read_weights(file);
  ASSERT_TRUE(read);
  const auto p = *read_fen(international_rules, "W:W28,36-45:B6-16");
  EXPECT_EQ(pattern_value(**read, p), pattern_value(built_in_weights(), p));
  std::FILE* f = std::fopen(file.c_str(), "ab");
  std::fputc(0, f);
  std::fclose(f);
  EXPECT_FALSE(read_weights(file));
  std::remove(file.c_str());
  EXPECT_FALSE(read_weights(file));
}

}  // namespace
}  // namespace counterpart
