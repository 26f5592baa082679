// The one place where the y-up axes of glTF and MakeHuman (y up, face along +z, left at +x) become those of the figure
// frame H (z up, face along +y, left at -x).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace counterpart {

// p_H = y_up_to_H() * p_y_up. A proper rotation and its own inverse.
inline Eigen::Matrix3f y_up_to_H() {
  Eigen::Matrix3f R;
  R << -1, 0, 0, 0, 0, 1, 0, 1, 0;
  return R;
}

inline Eigen::Vector3f H_from_y_up(const Eigen::Vector3f& p) {
  return {-p.x(), p.z(), p.y()};
}

inline Eigen::Vector3f y_up_from_H(const Eigen::Vector3f& p) {
  return {-p.x(), p.z(), p.y()};
}

}  // namespace counterpart
