// Calibration against crossings that were projected through a known camera.
#include "tracker_server/camera/calibrate.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/tracker_server/support/board_picture.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

constexpr double degree = std::numbers::pi / 180;

Intrinsics true_camera() {
  Intrinsics camera = test::camera_720x576(830);
  camera.cx = 371;
  camera.cy = 279;
  camera.dist = {-0.12, 0.05, 0.001, -0.0005, 0};
  return camera;
}

BoardSight sight_from(const Intrinsics& camera, const Eigen::Isometry3d& X_CB, double noise_px, cv::RNG& random) {
  BoardSight sight;
  for (int row = 1; row < 10; ++row)
    for (int col = 1; col < 10; ++col) {
      const Eigen::Vector2d p = project(camera, X_CB * Eigen::Vector3d(0.04 * col - 0.2, 0.2 - 0.04 * row, 0));
      sight.on_board.emplace_back(static_cast<float>(col), static_cast<float>(row), 0.0F);
      sight.in_picture.emplace_back(static_cast<float>(p.x() + random.gaussian(noise_px)),
                                    static_cast<float>(p.y() + random.gaussian(noise_px)));
    }
  return sight;
}

TEST(Calibrate, FindsTheCameraAndHowWellItKnowsIt) {
  cv::RNG random(5);
  std::vector<BoardSight> sights;
  for (int i = 0; i < 12; ++i)
    sights.push_back(sight_from(true_camera(),
                                test::looking_at_board(0.6 + 0.02 * i, (40 + 4 * (i % 4)) * degree, 30.0 * i * degree),
                                0.2, random));
  const auto result = calibrate(sights, 720, 576);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_NEAR(result->rms_px, 0.2 * std::sqrt(2.0), 0.03);
  EXPECT_GT(result->focal_sigma_px, 0);
  EXPECT_LT(result->focal_sigma_px, 0.01 * 830);
  // Four standard deviations: once in 16,000 seeds.
  EXPECT_LT(std::abs(result->camera.fx - 830), 4 * result->focal_sigma_px);
  EXPECT_NEAR(result->camera.cx, 371, 5);
  EXPECT_NEAR(result->camera.dist[0], -0.12, 0.02);
}

// A board seen squarely from above looks the same through a long lens from afar as through a short one from near.
TEST(Calibrate, SaysWhenThePicturesDoNotTellTheFocalLength) {
  cv::RNG random(5);
  std::vector<BoardSight> sights;
  for (int i = 0; i < 8; ++i)
    sights.push_back(
        sight_from(test::camera_720x576(), test::looking_at_board(0.8, 90 * degree, 40.0 * i * degree), 0.3, random));
  EXPECT_FALSE(calibrate(sights, 720, 576));
  sights.resize(2);
  EXPECT_FALSE(calibrate(sights, 720, 576));
}

}  // namespace
}  // namespace counterpart
