#include "stage/camera/path.hpp"

#include <gtest/gtest.h>

namespace counterpart::stage {
namespace {

TEST(CameraPath, StillWithoutOrbitAndShake) {
  EXPECT_TRUE(camera_at({}, 0).isApprox(camera_at({}, 7.7)));
}

TEST(CameraPath, ShakesBySeedAndAboutAsMuchAsAsked) {
  CameraPath path;
  path.shake_m = 0.002;
  const Eigen::Vector3d eye = path.eye_B;
  double squares = 0;
  constexpr int kCount = 2000;
  for (int i = 0; i < kCount; ++i) {
    squares += (camera_at(path, 0.04 * i).inverse().translation() - eye).squaredNorm() / (3 * kCount);
  }
  EXPECT_NEAR(std::sqrt(squares), 0.002, 0.0005);
  CameraPath other = path;
  other.seed = 2;
  EXPECT_FALSE(camera_at(path, 1).isApprox(camera_at(other, 1), 1e-6));
  EXPECT_TRUE(camera_at(path, 1).isApprox(camera_at(path, 1), 0));
}

TEST(CameraPath, OrbitKeepsTheDistanceToItsTarget) {
  CameraPath path;
  path.orbit_rad = 0.5;
  const double distance = (path.eye_B - path.target_B).norm();
  double widest = 0;
  for (double t = 0; t < 16; t += 0.1) {
    const Eigen::Vector3d eye = camera_at(path, t).inverse().translation();
    EXPECT_NEAR((eye - path.target_B).norm(), distance, 1e-9);
    widest = std::max(widest, (eye - path.eye_B).norm());
  }
  EXPECT_GT(widest, 0.3);
}

}  // namespace
}  // namespace counterpart::stage
