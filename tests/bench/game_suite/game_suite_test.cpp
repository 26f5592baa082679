// Short games of the suite, as part of every test run: the whole system from the camera's picture to the record.
#include <gtest/gtest.h>

#include "tests/bench/game_suite/plan.hpp"
#include "tests/bench/game_suite/play.hpp"

namespace counterpart::bench {
namespace {

TEST(GameSuite, ARecordSaysWhatWasReallyDone) {
  PlayOptions options;
  options.plies = 6;
  stage::Scenario scenario = plan_game(5, 1, options.plies);
  scenario.player.speed = 2.4;
  scenario.player.illegal_moves = {{1, stage::IllegalKind::backwards}};
  scenario.player.rests.clear();
  const auto played = play_game(scenario, options);
  ASSERT_TRUE(played) << played.error().message;
  EXPECT_TRUE(played->equal) << played->trouble;
  EXPECT_GE(played->plies, options.plies);
  EXPECT_EQ(played->wrong_commits, 0);
  EXPECT_EQ(played->illegal_made, 1);
  EXPECT_EQ(played->illegal_right, 1) << played->trouble;
  EXPECT_EQ(played->false_alarms, 0) << played->trouble;
  ASSERT_FALSE(played->recognised_s.empty());
  // At 25 frames a second; what happens in between, such as lights going out, is not in this game.
  for (const double seconds : played->recognised_s) EXPECT_LE(seconds, 0.6);
}

// The comparison must be able to fail: this system is asked to play on a board that it does not have before it.
TEST(GameSuite, AGameThatIsNotUnderstoodIsNotCalledEqual) {
  PlayOptions options;
  options.plies = 4;
  options.patience_s = 3;
  stage::Scenario scenario = plan_game(5, 1, options.plies);
  scenario.no_pieces = true;
  const auto played = play_game(scenario, options);
  ASSERT_TRUE(played) << played.error().message;
  EXPECT_FALSE(played->equal);
  EXPECT_FALSE(played->trouble.empty());
}

TEST(GameSuite, TheSeedAloneDecidesWhatHappens) {
  const stage::Scenario a = plan_game(9, 4, 30), same = plan_game(9, 4, 30), b = plan_game(9, 5, 30);
  EXPECT_EQ(a.board, same.board);
  EXPECT_EQ(a.path.eye_R, same.path.eye_R);
  EXPECT_EQ(a.events.size(), same.events.size());
  EXPECT_NE(a.path.eye_R, b.path.eye_R);
}

}  // namespace
}  // namespace counterpart::bench
