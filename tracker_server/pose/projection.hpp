// Points of the camera frame to pixels and back, with OpenCV's five distortion coefficients.
#pragma once

#include <Eigen/Core>

#include "protocol/vocabulary/intrinsics.hpp"

namespace counterpart {

inline bool is_distorted(const Intrinsics& camera) {
  for (double k : camera.dist)
    if (k != 0) return true;
  return false;
}

// Normalised coordinates (x/z, y/z) to pixels.
inline Eigen::Vector2d pixel_of_normalised(const Intrinsics& camera, double x, double y) {
  if (is_distorted(camera)) {
    const auto& [k1, k2, p1, p2, k3] = camera.dist;
    const double r2 = x * x + y * y;
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
    const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
    x = xd;
    y = yd;
  }
  return {camera.fx * x + camera.cx, camera.fy * y + camera.cy};
}

// p_C.z() must be positive.
inline Eigen::Vector2d project(const Intrinsics& camera, const Eigen::Vector3d& p_C) {
  return pixel_of_normalised(camera, p_C.x() / p_C.z(), p_C.y() / p_C.z());
}

// The inverse of pixel_of_normalised, by fixed-point iteration as OpenCV's undistortPoints does.
inline Eigen::Vector2d normalised_of_pixel(const Intrinsics& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d target((pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy);
  Eigen::Vector2d point = target;
  if (!is_distorted(camera)) return point;
  for (int round = 0; round < 20; ++round) {
    const Eigen::Vector2d seen = pixel_of_normalised(camera, point.x(), point.y());
    point += target - Eigen::Vector2d((seen.x() - camera.cx) / camera.fx, (seen.y() - camera.cy) / camera.fy);
  }
  return point;
}

// A camera of which nothing but the picture's size is known: square pixels, centred, no distortion.
inline Intrinsics centred_camera(int width, int height, double focal_px) {
  Intrinsics camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal_px;
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

}  // namespace counterpart
