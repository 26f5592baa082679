#include "tracker_server/pose/model_tracker.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/tracker_server/support/cube_picture.hpp"
#include "tracker_server/edges/pyramid.hpp"

namespace counterpart {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr std::int64_t frame_ns = 40'000'000;

TEST(ModelTracker, FollowsAStripedCubeThatTurns) {
  const Intrinsics camera = test::camera_640x480();
  ModelTracker tracker(test::cube_model(), Predictor::first, {});
  for (int frame = 0; frame < 60; ++frame) {
    Isometry3d X_CM = Isometry3d::Identity();
    X_CM.linear() =
        (Eigen::AngleAxisd(0.9, Vector3d::UnitX()) * Eigen::AngleAxisd(0.4 + 0.012 * frame, Vector3d::UnitZ()))
            .toRotationMatrix();
    X_CM.translation() = Vector3d(0.03 * std::sin(0.1 * frame), 0.01, 0.55);
    if (frame == 0) tracker.start_at(X_CM);
    cv::Mat picture(camera.height, camera.width, CV_8UC3, cv::Scalar::all(215));
    test::paint_cube(camera, X_CM, picture);
    const TrackedModel seen = tracker.track(build_pyramid(picture, 3), camera, frame * frame_ns);
    ASSERT_EQ(seen.status, TrackStatus::ok) << frame;
    // Stripes lie a few pixels inside the outlines; a pose that takes them for outlines is off by that much.
    EXPECT_LT(test::farthest_cube_corner_px(camera, seen.X_CM, X_CM), 1.0) << frame;
  }
}

}  // namespace
}  // namespace counterpart
