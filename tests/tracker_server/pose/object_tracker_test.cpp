#include "tracker_server/pose/object_tracker.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/tracker_server/support/board_picture.hpp"
#include "tests/tracker_server/support/cube_picture.hpp"
#include "tracker_server/edges/pyramid.hpp"
#include "tracker_server/pose/board_tracker.hpp"

namespace counterpart {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::int64_t frame_ns = 40'000'000;

Isometry3d cube_at(double x, double turn_rad) {
  Isometry3d X_CM = Isometry3d::Identity();
  X_CM.linear() = (AngleAxisd(0.9, Vector3d::UnitX()) * AngleAxisd(turn_rad, Vector3d::UnitZ())).toRotationMatrix();
  X_CM.translation() = Vector3d(x, 0.01, 0.7);
  return X_CM;
}

// The whole scene moves and turns a little, as from a hand-held camera.
Isometry3d shaken(int frame) {
  Isometry3d X = Isometry3d::Identity();
  X.linear() = AngleAxisd(0.004 * frame, Vector3d(0.2, 1, 0.1).normalized()).toRotationMatrix();
  X.translation() = Vector3d(0.002 * std::sin(0.3 * frame), 0.001 * frame, 0);
  return X;
}

cv::Mat grey_picture(const Intrinsics& camera) {
  return {camera.height, camera.width, CV_8UC3, cv::Scalar::all(215)};
}

TEST(ObjectTracker, FollowsTwoCubesThatMoveApart) {
  const Intrinsics camera = test::camera_640x480();
  ObjectTracker tracker(Predictor::first, {});
  tracker.add({{"left", test::cube_model(), cube_at(-0.12, 0.4)}});
  tracker.add({{"right", test::cube_model(), cube_at(0.12, 0.9)}});
  for (int frame = 0; frame < 25; ++frame) {
    const Isometry3d left = cube_at(-0.12 - 0.001 * frame, 0.4 + 0.01 * frame);
    const Isometry3d right = cube_at(0.12 + 0.0015 * frame, 0.9 - 0.01 * frame);
    cv::Mat picture = grey_picture(camera);
    test::paint_cube(camera, left, picture);
    test::paint_cube(camera, right, picture);
    const auto seen = tracker.track(build_pyramid(picture, 3), camera, frame * frame_ns);
    ASSERT_EQ(seen.size(), 2U);
    EXPECT_EQ(seen[0].name, "left");
    EXPECT_EQ(seen[1].name, "right");
    for (const TrackedObject& object : seen) ASSERT_EQ(object.status, TrackStatus::ok) << object.name << frame;
    // The farthest corner is one that is not seen; stripes beside the edges move it by up to three pixels, a wrong edge
    // by ten.
    EXPECT_LT(test::farthest_cube_corner_px(camera, seen[0].X_CM, left), 4.0) << frame;
    EXPECT_LT(test::farthest_cube_corner_px(camera, seen[1].X_CM, right), 4.0) << frame;
  }
}

// One of two cubes that are rigid to each other is covered: the other tells where it is. Alone it is lost.
TEST(ObjectTracker, ACoveredCubeIsToldByTheOneItIsRigidTo) {
  const Intrinsics camera = test::camera_640x480();
  const Isometry3d left = cube_at(-0.12, 0.4), right = cube_at(0.12, 0.9);
  ObjectTracker together(Predictor::first, {}), apart(Predictor::first, {});
  together.add({{"left", test::cube_model(), left}, {"right", test::cube_model(), right}});
  apart.add({{"left", test::cube_model(), left}});
  apart.add({{"right", test::cube_model(), right}});
  for (int frame = 0; frame < 20; ++frame) {
    const Isometry3d X = shaken(frame);
    cv::Mat picture = grey_picture(camera);
    test::paint_cube(camera, X * left, picture);
    test::paint_cube(camera, X * right, picture);
    if (frame >= 5) cv::rectangle(picture, {320, 0, 320, 480}, cv::Scalar::all(170), cv::FILLED);
    const Pyramid pyramid = build_pyramid(picture, 3);
    const auto joint = together.track(pyramid, camera, frame * frame_ns);
    const auto single = apart.track(pyramid, camera, frame * frame_ns);
    ASSERT_EQ(joint[1].status, TrackStatus::ok) << frame;
    EXPECT_LT(test::farthest_cube_corner_px(camera, joint[0].X_CM, X * left), 4.0) << frame;
    // The farther from what is seen, the more a small error of the angle moves.
    EXPECT_LT(test::farthest_cube_corner_px(camera, joint[1].X_CM, X * right), 5.0) << frame;
    if (frame >= 8) {
      EXPECT_EQ(single[1].status, TrackStatus::lost) << frame;
    }
  }
}

// A box that stands beside the board and is known to: the board is told, and not far off, while paper covers all of it.
TEST(BoardTracker, IsHeldByAFixtureWhileTheWholeBoardIsCovered) {
  test::BoardScene scene;
  scene.camera = test::camera_720x576(700);
  scene.table_bgr = {215, 215, 210};  // unlike any face of the box
  Isometry3d X_BM = Isometry3d::Identity();
  X_BM.linear() = AngleAxisd(0.5, Vector3d::UnitZ()).toRotationMatrix();
  X_BM.translation() = Vector3d(0.34, 0.02, test::cube_half_m);
  BoardTrackerOptions options;
  options.board = scene.board;
  options.camera = scene.camera;
  options.fixtures = {{test::cube_model(), X_BM}};
  BoardTracker tracker(options);
  for (int frame = 0; frame < 16; ++frame) {
    scene.X_CB = shaken(frame) * test::looking_at_board(1.1, 0.8, 0.1);
    if (frame == 0) tracker.start_at(scene.X_CB);  // an empty board alone does not tell which way round it lies
    if (frame >= 6)
      scene.before = [](int x, int) { return x < 505 ? std::optional(cv::Vec3b(200, 200, 200)) : std::nullopt; };
    cv::Mat picture = test::paint(scene, 2);
    test::paint_cube(scene.camera, scene.X_CB * X_BM, picture);
    const TrackedBoard seen = tracker.track(picture, frame * frame_ns);
    ASSERT_TRUE(seen.status == TrackStatus::ok || (frame == 0 && seen.status == TrackStatus::relocalised)) << frame;
    const double off = test::farthest_crossing_px(scene.board, scene.camera, seen.X_CB, scene.camera, scene.X_CB);
    // A box of 10 cm tells where a corner half a metre away is.
    EXPECT_LT(off, frame < 6 ? 0.5 : 6.0) << frame;
  }
}

}  // namespace
}  // namespace counterpart
