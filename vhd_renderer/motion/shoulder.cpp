#include "vhd_renderer/motion/shoulder.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace counterpart {

using Eigen::Vector3f;

float ShoulderAngles::excess_rad(float margin_rad) const {
  const auto excess = [&](const AngleRange& range, float angle) {
    return AngleRange{range.least_rad + margin_rad, range.most_rad - margin_rad}.excess(angle);
  };
  return std::max({excess(joint_limit::arm_backwards, backwards_rad), excess(joint_limit::arm_across, across_rad),
                   excess(joint_limit::arm_inward, inward_rad)});
}

ShoulderAngles shoulder_angles(const Vector3f& upper, const Vector3f& hinge, float side) {
  // Against an arm that was swung from hanging the shortest way, its elbow closing forwards.
  const Vector3f swung = Eigen::Quaternionf::FromTwoVectors(-Vector3f::UnitZ(), upper) * Vector3f::UnitX();
  return {std::asin(std::clamp(-upper.y(), -1.F, 1.F)), std::asin(std::clamp(-side * upper.x(), -1.F, 1.F)),
          -side * std::atan2(swung.cross(hinge).dot(upper), swung.dot(hinge))};
}

}  // namespace counterpart
