// From board frame to pixel: the one place where OpenCV's camera becomes OpenGL's.
#pragma once

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "protocol/vocabulary/intrinsics.hpp"

namespace counterpart {

struct View {
  Intrinsics intrinsics;
  Eigen::Isometry3d X_CB = Eigen::Isometry3d::Identity();
};

// OpenCV's distortion of normalised image coordinates (x/z, y/z).
Eigen::Vector2d distort(const Eigen::Vector2d& xy, const std::array<double, 5>& dist);

// Pixel of a point of B; the centre of the first pixel is (0, 0). The point must be in front of the camera.
Eigen::Vector2d project(const View& view, const Eigen::Vector3d& p_B);

// Squared radius up to which the distortion grows with the radius. Beyond it the polynomial folds back into the
// picture, so nothing out there may be distorted by it.
double usable_radius_squared(const std::array<double, 5>& dist);

// Where the camera is, in B.
Eigen::Vector3d camera_position_B(const View& view);

// Looks from one point of B to another; the picture's upper side is towards B's z axis.
Eigen::Isometry3d look_at_X_CB(const Eigen::Vector3d& eye_B, const Eigen::Vector3d& target_B);

constexpr double kNear_m = 0.05;
constexpr double kFar_m = 40.0;

// Takes (xd * z, yd * z, z, 1) -- the point in C with its distorted direction -- to OpenGL's clip coordinates. Rows run
// downwards as in OpenCV, so that what is read back needs no flip; the front of a face is clockwise therefore.
Eigen::Matrix4f clip_from_camera(const Intrinsics& intrinsics);

}  // namespace counterpart
