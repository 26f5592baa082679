#include "stage/room/warp.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace counterpart::stage {
namespace {

TEST(Warp, IsAsLargeAsAskedAndHasNoLiftAndNoTilt) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Warp warp(0.001, 0.23, seed);
    double largest = 0, lift = 0, tilt_x = 0, tilt_y = 0;
    constexpr int steps = 100;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const double x = (2 * (i + 0.5) / steps - 1) * 0.23, y = (2 * (j + 0.5) / steps - 1) * 0.23;
        const double z = warp.height_m(x, y);
        largest = std::max(largest, std::abs(z));
        lift += z;
        tilt_x += z * x;
        tilt_y += z * y;
      }
    EXPECT_LE(largest, 0.001);
    EXPECT_GT(largest, 0.0003) << "seed " << seed;
    // Over the 10,000 places; the sum over a grid is good to some hundredths of a per cent of the integral.
    EXPECT_LT(std::abs(lift), 0.001 * 10);
    EXPECT_LT(std::abs(tilt_x), 0.001 * 0.23 * 10);
    EXPECT_LT(std::abs(tilt_y), 0.001 * 0.23 * 10);
  }
}

TEST(Warp, OfAFlatBoardIsNone) {
  EXPECT_EQ(Warp(0, 0.2, 3).height_m(0.1, 0.15), 0);
  EXPECT_EQ(Warp().height_m(0.1, 0.15), 0);
}

}  // namespace
}  // namespace counterpart::stage
