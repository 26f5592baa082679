// The one conversion between the vocabulary's poses and Eigen's. For rooms that use Eigen; the protocol itself does
// not.
#pragma once

#include <Eigen/Geometry>

#include "protocol/vocabulary/pose.hpp"

namespace counterpart {

inline Eigen::Vector3d to_eigen(const Point3& p) {
  return {p[0], p[1], p[2]};
}
inline Point3 to_point(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

inline Eigen::Isometry3d to_eigen(const Pose& X_AB) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::Quaterniond(X_AB.q[0], X_AB.q[1], X_AB.q[2], X_AB.q[3]).normalized().toRotationMatrix();
  X.translation() = to_eigen(X_AB.p);
  return X;
}

// The quaternion is written with w >= 0, so that equal poses have equal numbers.
inline Pose to_pose(const Eigen::Isometry3d& X_AB) {
  Eigen::Quaterniond q(X_AB.linear());
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return {{q.w(), q.x(), q.y(), q.z()}, to_point(X_AB.translation())};
}

}  // namespace counterpart
