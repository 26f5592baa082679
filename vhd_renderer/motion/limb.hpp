// Two-bone limbs: a closed form, with a pole that says where elbow or knee goes.
#pragma once

#include "vhd_renderer/motion/anatomy.hpp"
#include "vhd_renderer/motion/pose.hpp"

namespace counterpart {

struct LimbGoal {
  Eigen::Vector3f end_S{0, 0, 0};
  Eigen::Quaternionf end_G;          // rotation of hand or foot from bind
  Eigen::Vector3f pole_S{0, 0, -1};  // direction towards which the middle joint points
  float root_twist_share = 0.5F;     // of the upper bone's twist that its twist joint takes
  float end_twist_share = 0.7F;      // of the hand's twist that the forearm takes
};

// Bends the limb and sets hand or foot; returns how far the end stays from its goal, metres.
float solve_limb(const Figure& figure, const Limb& limb, const LimbGoal& goal, BodyPose& pose);

// Where the middle joint would be.
Eigen::Vector3f middle_place(const Limb& limb, const Eigen::Vector3f& root_S, const Eigen::Vector3f& end_S,
                             const Eigen::Vector3f& pole_S);

}  // namespace counterpart
