// Two-bone limbs: a closed form, with a pole that says where elbow or knee goes.
#pragma once

#include "vhd_renderer/motion/anatomy.hpp"
#include "vhd_renderer/motion/pose.hpp"
#include "vhd_renderer/motion/wrist.hpp"

namespace counterpart {

struct LimbGoal {
  Eigen::Vector3f end_S{0, 0, 0};
  Eigen::Quaternionf end_G;          // rotation of hand or foot from bind
  Eigen::Vector3f pole_S{0, 0, -1};  // direction towards which the middle joint points
  float root_twist_share = 0.5F;     // of the upper bone's twist that its twist joint takes
  AngleRange root_twist{-4, 4};      // and where that has to stay
  float end_twist_share = 0.7F;      // of the hand's twist that the forearm takes
};

// The twist joint's angle, radians; 0 if the limb has none.
float root_twist_of(const Figure& figure, const Limb& limb, const BodyPose& pose);

// Bends the limb and sets hand or foot; returns how far the end stays from its goal, metres.
float solve_limb(const Figure& figure, const Limb& limb, const LimbGoal& goal, BodyPose& pose);

// How the limb would be bent.
struct LimbBend {
  Eigen::Vector3f middle_S;  // where elbow or knee is
  Eigen::Vector3f upper_S;   // unit, directions of the two bones
  Eigen::Vector3f lower_S;
  Eigen::Vector3f hinge_S;  // unit
};
LimbBend bend_of(const Limb& limb, const Eigen::Vector3f& root_S, const Eigen::Vector3f& end_S,
                 const Eigen::Vector3f& pole_S);

}  // namespace counterpart
