#include "vhd_renderer/motion/hand_lift.hpp"

#include <algorithm>
#include <cmath>

#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float finger_m = 0.012F;      // what flesh there is about a finger's bone
constexpr float at_ease_m = 0.008F;     // farther up than this no finger has to be
constexpr float off_table_m = 0.0015F;  // nor lower than this

// How high a point is over the table's top, or over the board where it is there. The board begins softly, so that a
// hand that slides on to it does not jump; before the table there is nothing.
float height_over_table(const BodyControls& c, const Vector3f& p_S) {
  const float beside_board = std::max(std::abs(p_S.x()), std::abs(p_S.y())) - c.board_half_m;
  const float on_board = unit_clamp(2 - beside_board / finger_m);
  const float over_edge = unit_clamp((p_S.y() - c.table_edge_y_m) / finger_m);
  return p_S.z() - lerp(c.table_z_m, 0.F, on_board) + (1 - over_edge) * 0.5F;
}

float lowest(const BodyControls& c, const FingerEnds& ends_W, const Vector3f& wrist_S, const Quaternionf& R_SW) {
  float least = 1;
  for (const Vector3f& p_W : ends_W) least = std::min(least, height_over_table(c, wrist_S + R_SW * p_W));
  return least;
}

}  // namespace

FingerEnds finger_ends_W(const Figure& figure, const HandParts& hand, const HandShape& shape) {
  FingerEnds ends;
  for (std::size_t f = 0; f < hand.fingers.size(); ++f) {
    const Fingertip tip = fingertip_W(figure, hand, shape, f);
    ends[2 * f] = tip.tip;
    ends[2 * f + 1] = tip.pad;
  }
  return ends;
}

float lift_out_of_table(const BodyControls& c, const ArmGoal& goal, const FingerEnds& ends_W, const Vector3f& wrist_S,
                        const Quaternionf& R_SW) {
  const bool as_wanted = R_SW.angularDistance(goal.R_SW) < radians(0.5F) && (wrist_S - goal.wrist_S).norm() < 0.0005F;
  if (as_wanted) return 0;
  // A hand under the table stays there.
  const float above = unit_clamp((goal.wrist_S.z() - c.table_z_m + 0.01F) / 0.03F);
  const float wanted = std::clamp(lowest(c, ends_W, goal.wrist_S, goal.R_SW), off_table_m, at_ease_m);
  return above * std::max(0.F, wanted - lowest(c, ends_W, wrist_S, R_SW));
}

}  // namespace counterpart
