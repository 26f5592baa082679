// A striped cube painted into a picture, with exact truth.
#pragma once

#include <array>
#include <string>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/intrinsics.hpp"
#include "tracker_server/pose/model.hpp"

namespace counterpart::test {

constexpr double cube_half_m = 0.05;

const std::array<Eigen::Vector3d, 8>& cube_corners();  // model frame
std::string cube_obj();
Model cube_model();

// Painted four times as large and made smaller, so that edges are right to a few hundredths of a pixel. Stripes on
// every face are edges that the model does not have. The picture (BGR) is of the camera's size.
void paint_cube(const Intrinsics& camera, const Eigen::Isometry3d& X_CM, cv::Mat& picture);

Intrinsics camera_640x480();

// The largest distance in the picture between a corner at two poses, pixels.
double farthest_cube_corner_px(const Intrinsics& camera, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

}  // namespace counterpart::test
