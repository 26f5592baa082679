// Commands at random (in full, 10,000: tests/bench/measure_human commands, or COUNTERPART_LONG=1).
#include <cstdlib>

#include "tests/vhd_renderer/motion/human_measures.hpp"

namespace counterpart {
namespace {

TEST(DirectorCommands, EachGetsExactlyOneFinalAnswerAndTheBodyStaysABody) {
  const int count = std::getenv("COUNTERPART_LONG") != nullptr ? 10'000 : 1000;
  const Figure figure = mannequin();
  PoseJudge judge(figure);
  ChaosFigures f = measure_chaos(figure, count, 11, judge);
  EXPECT_EQ(f.commands, count);
  EXPECT_EQ(f.without_answer, 0);
  EXPECT_EQ(f.with_several, 0);
  EXPECT_EQ(f.said_after_end, 0);
  EXPECT_GT(f.ends[FeedbackState::finished], count / 20) << "the dice let some of them be done";
  EXPECT_GT(f.ends[FeedbackState::cancelled], count / 20);
  EXPECT_GT(f.ends[FeedbackState::failed], count / 50);
  EXPECT_TRUE(f.legal_end);
  EXPECT_TRUE(judge.finite);
  expect_within_bounds(judge);
}

}  // namespace
}  // namespace counterpart
