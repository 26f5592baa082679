#include "stage/camera/path.hpp"

#include <gtest/gtest.h>

namespace counterpart::stage {
namespace {

TEST(CameraPath, StillWithoutOrbitAndShake) {
  EXPECT_TRUE(camera_at_X_CR({}, 0).isApprox(camera_at_X_CR({}, 7.7)));
}

TEST(CameraPath, ShakesBySeedAndAboutAsMuchAsAsked) {
  CameraPath path;
  path.shake_m = 0.002;
  const Eigen::Vector3d eye = path.eye_R;
  double squares = 0;
  constexpr int kCount = 2000;
  for (int i = 0; i < kCount; ++i) {
    squares += (camera_at_X_CR(path, 0.04 * i).inverse().translation() - eye).squaredNorm() / (3 * kCount);
  }
  EXPECT_NEAR(std::sqrt(squares), 0.002, 0.0005);
  CameraPath other = path;
  other.seed = 2;
  EXPECT_FALSE(camera_at_X_CR(path, 1).isApprox(camera_at_X_CR(other, 1), 1e-6));
  EXPECT_TRUE(camera_at_X_CR(path, 1).isApprox(camera_at_X_CR(path, 1), 0));
}

TEST(CameraPath, OrbitKeepsTheDistanceToItsTarget) {
  CameraPath path;
  path.orbit_rad = 0.5;
  const double distance = (path.eye_R - path.target_R).norm();
  double widest = 0;
  for (double t = 0; t < 16; t += 0.1) {
    const Eigen::Vector3d eye = camera_at_X_CR(path, t).inverse().translation();
    EXPECT_NEAR((eye - path.target_R).norm(), distance, 1e-9);
    widest = std::max(widest, (eye - path.eye_R).norm());
  }
  EXPECT_GT(widest, 0.3);
}

TEST(CameraPath, ZoomStartsAtOneAndReachesBothEnds) {
  CameraPath path;
  path.zoom_low = 0.7;
  path.zoom_high = 1.3;
  EXPECT_NEAR(zoom_at(path, 0), 1, 1e-9);
  double low = 1, high = 1;
  for (double t = 0; t < path.zoom_period_s; t += 0.02) {
    low = std::min(low, zoom_at(path, t));
    high = std::max(high, zoom_at(path, t));
  }
  EXPECT_NEAR(low, 0.7, 1e-3);
  EXPECT_NEAR(high, 1.3, 1e-3);
}

// 0.5 rad/s at 25 frames a second and a focal length of 600 pixels are 12 pixels a frame in the picture's middle.
TEST(CameraPath, SweepMovesThePictureAtItsSpeed) {
  CameraPath path;
  path.sweep_rad_s = 0.5;
  View before, after;
  before.intrinsics = after.intrinsics = {1, 720, 576, 600, 600, 359.5, 287.5, {}};
  for (double t = 2; t < 6; t += 0.37) {
    before.X_CB = camera_at_X_CR(path, t);
    after.X_CB = camera_at_X_CR(path, t + 0.04);
    const Eigen::Vector3d seen = before.X_CB.inverse() * Eigen::Vector3d(0, 0, 1);
    EXPECT_NEAR((project(after, seen) - project(before, seen)).norm(), 12, 0.7);
  }
}

}  // namespace
}  // namespace counterpart::stage
