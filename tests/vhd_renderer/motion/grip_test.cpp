#include "vhd_renderer/motion/grip.hpp"

#include <gtest/gtest.h>

#include "vhd_renderer/body/mannequin.hpp"

namespace counterpart {
namespace {

// Discs that are sold: travel sets, 8 x 8 and 10 x 10 sets, tournament pieces.
TEST(Grip, ClosesOnPiecesOfManySizes) {
  const Figure figure = mannequin();
  const Anatomy anatomy = anatomy_of(figure).value();
  for (const GripTarget& target :
       {GripTarget{0.016F, 0.008F, 0.04F}, GripTarget{0.0115F, 0.006F, 0.03F}, GripTarget{0.0185F, 0.009F, 0.05F}}) {
    for (const std::size_t side : {left_side, right_side}) {
      const Grip grip = grip_on_piece(figure, anatomy.arms[side].hand, target);
      EXPECT_LT(grip.residual_mm, 1.F) << "radius " << target.radius_m << " side " << side;
      EXPECT_GT(grip.X_WP.translation().x(), 0.06F) << "the piece lies before the palm";
      float lowest = 1;
      for (const Eigen::Vector3f& p : grip.open_skin_P) lowest = std::min(lowest, p.z());
      EXPECT_GT(lowest, -0.001F) << "the open hand stays over the board";
    }
  }
}

}  // namespace
}  // namespace counterpart
