#include "protocol/daemon/step_times.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace counterpart {
namespace {

TEST(StepTimes, ReportsMedianNinetyFifthAndMaximum) {
  StepTimes times;
  for (int i = 0; i <= 100; ++i) times.add("pose", i);
  const auto report = times.report();
  EXPECT_EQ(report["pose"]["median"], 50.0);
  EXPECT_EQ(report["pose"]["p95"], 95.0);
  EXPECT_EQ(report["pose"]["max"], 100.0);
  EXPECT_EQ(report["pose"]["count"], 101);
}

TEST(StepTimes, KeepsTheNewestWhenItRunsForDays) {
  StepTimes times;
  for (int i = 0; i < 20'000; ++i) times.add("pose", 1000.0);
  for (int i = 0; i < 20'000; ++i) times.add("pose", 1.0);
  EXPECT_EQ(times.report()["pose"]["max"], 1.0);
  EXPECT_EQ(times.report()["pose"]["count"], 40'000);
}

}  // namespace
}  // namespace counterpart
