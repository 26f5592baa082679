// How an elbow is lifted out of its natural place: an angle about the line from shoulder to wrist.
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace counterpart {

struct Swivel {
  Eigen::Vector3f natural;  // direction of the elbow that hangs down and a little outward
  Eigen::Vector3f line;     // unit, shoulder to wrist
  float side = 1;           // 1: right arm, -1: left arm

  // `heading`: of the body.
  static Swivel of_arm(const Eigen::Quaternionf& heading, const Eigen::Vector3f& shoulder, const Eigen::Vector3f& wrist,
                       float side) {
    return {heading * Eigen::Vector3f(side * 0.62F, -0.35F, -0.75F), (wrist - shoulder).normalized(), side};
  }

  Eigen::Vector3f turned(float angle_rad) const { return Eigen::AngleAxisf(-side * angle_rad, line) * natural; }

  // Of an elbow in this direction from the line.
  float angle_of(const Eigen::Vector3f& elbow) const {
    const Eigen::Vector3f a = natural - line * line.dot(natural);
    const Eigen::Vector3f b = elbow - line * line.dot(elbow);
    return -side * std::atan2(a.cross(b).dot(line), a.dot(b));
  }
};

}  // namespace counterpart
