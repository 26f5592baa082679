#include "vhd_renderer/motion/walk.hpp"

#include "tests/vhd_renderer/motion/human_measures.hpp"

namespace counterpart {
namespace {

TEST(Walk, SolesThatBearDoNotSlide) {
  const SlideFigures f = measure_walk(mannequin());
  EXPECT_GT(f.steps, 20) << "there were steps to look at";
  EXPECT_LT(f.worst_mm, 5.F) << "in a step";
  EXPECT_LT(f.lifted_mm, 5.F) << "one foot is always on the floor";
  EXPECT_LT(f.sunk_mm, 5.F);
}

}  // namespace
}  // namespace counterpart
