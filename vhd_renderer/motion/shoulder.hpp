// How far a shoulder goes: where the upper arm points, and how it is turned about itself.
#pragma once

#include <Eigen/Core>

#include "vhd_renderer/motion/wrist.hpp"

namespace counterpart {

// Active ranges of healthy adults, rounded outwards (Kapandji), of the upper arm against the upper trunk.
namespace joint_limit {
inline constexpr AngleRange arm_backwards{-90 * degree, 65 * degree};
inline constexpr AngleRange arm_across{-90 * degree, 55 * degree};  // positive: in front of the other side
inline constexpr AngleRange arm_inward{-95 * degree, 110 * degree};
}  // namespace joint_limit

struct ShoulderAngles {
  float backwards_rad = 0;
  float across_rad = 0;
  float inward_rad = 0;  // turn about the upper arm, from an arm swung up from hanging the shortest way

  // How far the worst of them is beyond its range, or nearer to its end than `margin_rad`; 0: none is.
  float excess_rad(float margin_rad = 0) const;
};

// `upper` and `hinge`: unit, the upper arm's direction and the elbow's axis, in the trunk's axes as at bind; `side`: 1
// for the right arm, -1 for the left one.
ShoulderAngles shoulder_angles(const Eigen::Vector3f& upper, const Eigen::Vector3f& hinge, float side);

}  // namespace counterpart
