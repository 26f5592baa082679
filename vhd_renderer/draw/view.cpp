#include "vhd_renderer/draw/view.hpp"

#include <algorithm>

namespace counterpart {

Eigen::Vector2d distort(const Eigen::Vector2d& xy, const std::array<double, 5>& dist) {
  const auto [k1, k2, p1, p2, k3] = dist;
  const double x = xy.x();
  const double y = xy.y();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

Eigen::Vector2d project(const View& view, const Eigen::Vector3d& p_B) {
  const Eigen::Vector3d p_C = view.X_CB * p_B;
  const Eigen::Vector2d xy = distort(p_C.head<2>() / p_C.z(), view.intrinsics.dist);
  return {view.intrinsics.fx * xy.x() + view.intrinsics.cx, view.intrinsics.fy * xy.y() + view.intrinsics.cy};
}

double usable_radius_squared(const std::array<double, 5>& dist) {
  constexpr double kLargest = 9;  // tan of 71 degrees, squared: beyond any lens without its own model
  for (double r2 = 0; r2 < kLargest; r2 += 0.01) {
    const double slope = 1 + r2 * (3 * dist[0] + r2 * (5 * dist[1] + r2 * 7 * dist[4]));
    if (slope <= 0.05) return std::max(0.01, r2 - 0.01);
  }
  return kLargest;
}

Eigen::Vector3d camera_position_B(const View& view) {
  return view.X_CB.inverse().translation();
}

Eigen::Isometry3d look_at_X_CB(const Eigen::Vector3d& eye_B, const Eigen::Vector3d& target_B) {
  const Eigen::Vector3d forward = (target_B - eye_B).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d X_CB = Eigen::Isometry3d::Identity();
  X_CB.linear().row(0) = right.transpose();
  X_CB.linear().row(1) = forward.cross(right).transpose();
  X_CB.linear().row(2) = forward.transpose();
  X_CB.translation() = -(X_CB.linear() * eye_B);
  return X_CB;
}

Eigen::Matrix4f clip_from_camera(const Intrinsics& k) {
  // A pixel's centre is (u, v) = whole numbers in OpenCV and half numbers in OpenGL's window: hence the 0.5.
  Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
  m(0, 0) = 2 * k.fx / k.width;
  m(0, 2) = 2 * (k.cx + 0.5) / k.width - 1;
  m(1, 1) = 2 * k.fy / k.height;
  m(1, 2) = 2 * (k.cy + 0.5) / k.height - 1;
  m(2, 2) = (kFar_m + kNear_m) / (kFar_m - kNear_m);
  m(2, 3) = -2 * kFar_m * kNear_m / (kFar_m - kNear_m);
  m(3, 2) = 1;
  return m.cast<float>();
}

}  // namespace counterpart
