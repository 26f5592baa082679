#include "tracker_server/pose/lens_estimator.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/tracker_server/support/board_picture.hpp"
#include "tracker_server/pose/board_tracker.hpp"

namespace counterpart {
namespace {

constexpr double degree = std::numbers::pi / 180;

// A camera walks round the board; its lens bends and its middle is not where it is thought to be. What was thought at
// first is a lens without distortion and a focal length 8 % too short.
TEST(LensEstimator, FindsTheLensWhileTracking) {
  test::BoardScene scene;
  scene.camera = test::camera_720x576(700);
  scene.camera.cx += 9;
  scene.camera.cy -= 6;
  scene.camera.dist = {-0.15, 0.03, 0, 0, 0};
  BoardTrackerOptions options;
  options.board = scene.board;
  options.camera = test::camera_720x576(645);
  options.focal = FocalMode::estimate;
  options.estimate_lens = true;
  BoardTracker tracker(options);
  TrackedBoard seen;
  for (int frame = 0; frame < 32; ++frame) {
    const double turn = 9.0 * frame * degree;
    scene.X_CB = test::looking_at_board(0.62 + 0.1 * std::sin(0.7 * turn), (48 + 10 * std::cos(1.3 * turn)) * degree,
                                        turn, 10 * std::sin(turn) * degree);
    scene.seed = static_cast<unsigned>(frame);
    seen = tracker.track(test::paint(scene, 1), frame * 40'000'000LL);
    ASSERT_NE(seen.status, TrackStatus::lost) << frame;
  }
  // A dozen sights or more of a board that fills half of the picture, each crossing to a few tenths of a pixel.
  EXPECT_NEAR(seen.camera.fx, scene.camera.fx, 0.01 * scene.camera.fx);
  EXPECT_NEAR(seen.camera.cx, scene.camera.cx, 3);
  EXPECT_NEAR(seen.camera.cy, scene.camera.cy, 3);
  EXPECT_NEAR(seen.camera.dist[0], scene.camera.dist[0], 0.04);
  const Eigen::Isometry3d turned = scene.X_CB * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ());
  EXPECT_LT(std::min(test::farthest_crossing_px(scene.board, scene.camera, scene.X_CB, seen.camera, seen.X_CB),
                     test::farthest_crossing_px(scene.board, scene.camera, turned, seen.camera, seen.X_CB)),
            0.5);
}

}  // namespace
}  // namespace counterpart
