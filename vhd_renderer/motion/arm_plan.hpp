// Where a wrist and an elbow go in a frame: to what the arm's goal says as far as a shoulder lets them, out of the
// table, and never in a jump. A goal that no arm gets to in this frame is gone towards.
#pragma once

#include "vhd_renderer/motion/body_controls.hpp"
#include "vhd_renderer/motion/pose.hpp"

namespace counterpart {

struct ArmPlan {
  Eigen::Vector3f wrist_S{0, 0, 0};
  Eigen::Vector3f pole_S{0, 0, -1};  // towards the elbow
  float strain_rad = 0;              // beyond what a shoulder does at its ease, or too fast; 0: fine
  ArmMemory memory;                  // without the bend of the wrist, which is not planned here
};

// `pose`: trunk and shoulder joint up to date. `before`: of the frame before; null if there was none.
ArmPlan plan_arm(const Anatomy& anatomy, const BodyControls& controls, const ArmGoal& goal, const BodyPose& pose,
                 std::size_t side, const ArmMemory* before);

}  // namespace counterpart
