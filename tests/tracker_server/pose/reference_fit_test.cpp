#include "tracker_server/pose/reference_fit.hpp"

#include <numbers>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/tracker_server/support/board_picture.hpp"
#include "tracker_server/pose/board_tracker.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

using Eigen::Isometry3d;
using test::BoardScene;
using test::farthest_crossing_px;
using test::looking_at_board;

constexpr double degree = std::numbers::pi / 180;

BoardScene scene_with_pieces() {
  BoardScene scene;
  scene.camera = test::camera_720x576();
  scene.pieces = test::start_position(scene.board);
  return scene;
}

// A camera that swings round the board, faster and faster at first, then by 3.6 degrees a frame.
Isometry3d swung(double frame) {
  const double turned = frame < 6 ? frame * frame / 12 : frame - 3;
  return looking_at_board(0.8, 52 * degree, (3.6 * turned - 15) * degree);
}

// With the shutter open for a share of the time between two frames. Light adds up, and a picture's numbers go with
// about the square root of light.
cv::Mat exposed(BoardScene scene, double frame, double shutter_share, int moments) {
  cv::Mat light(scene.camera.height, scene.camera.width, CV_32FC3, cv::Scalar::all(0));
  for (int i = 0; i < moments; ++i) {
    scene.X_CB = swung(frame + shutter_share * ((i + 0.5) / moments - 0.5));
    scene.seed = static_cast<unsigned>(1 + i + moments * static_cast<int>(frame));
    cv::Mat part;
    test::paint(scene, 1).convertTo(part, CV_32FC3);
    light += part.mul(part) / moments;
  }
  cv::sqrt(light, light);
  cv::Mat picture;
  light.convertTo(picture, CV_8UC3);
  return picture;
}

double way_px(const BoardScene& scene, const Isometry3d& a, const Isometry3d& b) {
  return farthest_crossing_px(scene.board, scene.camera, a, scene.camera, b);
}

TEST(ReferenceFit, APictureSmearedOverTwentyPixelsIsAlignedWithASharpOne) {
  BoardScene scene = scene_with_pieces();
  scene.X_CB = swung(0);
  const ReferenceView reference{build_pyramid(test::paint(scene, 2), 3), scene.camera, scene.X_CB};
  const double frame = 9;
  const Isometry3d X = swung(frame);
  ASSERT_GT(way_px(scene, swung(frame - 1), X), 20);
  const Pyramid smeared = build_pyramid(exposed(scene, frame, 1, 11), 3);
  // A prediction that is several pixels off.
  const Isometry3d start = swung(frame - 0.25);
  ASSERT_GT(way_px(scene, start, X), 5);
  const auto fit = fit_to_reference(smeared, scene.camera, reference, scene.board, start,
                                    {swung(frame - 2), swung(frame - 1), start, 1});
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->likeness, 0.85);
  // The reference is exact to some hundredths of a pixel; pieces stand above the plane and show other sides.
  EXPECT_LT(way_px(scene, fit->X_CB, X), 0.5);

  // Taken for a picture with a short exposure, it looks less as it should.
  const auto sharp = fit_to_reference(smeared, scene.camera, reference, scene.board, start,
                                      {swung(frame - 2), swung(frame - 1), start, 0});
  ASSERT_TRUE(sharp);
  EXPECT_LT(sharp->likeness, fit->likeness - 0.01);
}

TEST(ReferenceFit, AnotherBoardIsNotTakenForThisOne) {
  BoardScene scene = scene_with_pieces();
  scene.X_CB = swung(0);
  const ReferenceView reference{build_pyramid(test::paint(scene, 1), 3), scene.camera, scene.X_CB};
  std::swap(scene.light_bgr, scene.dark_bgr);  // as if it lay one square along
  const Pyramid other = build_pyramid(test::paint(scene, 1), 3);
  const auto fit = fit_to_reference(other, scene.camera, reference, scene.board, swung(0), {{}, swung(0), swung(0), 1});
  if (fit) {
    EXPECT_LT(fit->likeness, 0.45);
  }
}

TEST(ReferenceFit, WithoutTheBoardThereIsNoPose) {
  BoardScene scene = scene_with_pieces();
  scene.X_CB = swung(0);
  const Pyramid pyramid = build_pyramid(test::paint(scene, 1), 3);
  const ReferenceView reference{pyramid, scene.camera, scene.X_CB};
  Isometry3d beside = scene.X_CB;
  beside.translation().x() += 5;
  EXPECT_FALSE(fit_to_reference(pyramid, scene.camera, reference, scene.board, beside, {{}, beside, beside, 1}));
  Isometry3d behind = scene.X_CB;
  behind.translation().z() *= -1;
  EXPECT_FALSE(fit_to_reference(pyramid, scene.camera, reference, scene.board, behind, {{}, behind, behind, 1}));
}

// The shutter is always open while the camera swings faster and faster, and an arm lies over a part of the board.
TEST(BoardTracker, HoldsASmearedBoardUnderAnArm) {
  BoardScene scene = scene_with_pieces();
  scene.camera = centred_camera(360, 288, 450);  // half the usual size: 11 pixels of 14 that a square has
  scene.before = [](int x, int y) -> std::optional<cv::Vec3b> {
    if (x > 150 && x < 190 && y > 130) return cv::Vec3b(110, 130, 180);
    return std::nullopt;
  };
  BoardTrackerOptions options;
  options.board = scene.board;
  options.camera = scene.camera;
  BoardTracker tracker(options);
  for (int frame = 0; frame <= 11; ++frame) {
    const TrackedBoard seen = tracker.track(exposed(scene, frame, 1, 5), frame * 40'000'000);
    ASSERT_TRUE(seen.status == TrackStatus::ok || seen.status == TrackStatus::relocalised) << "frame " << frame;
    // Until the pieces tell, either way round is right.
    const Isometry3d turned = swung(frame) * Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ());
    const double off_px = std::min(way_px(scene, seen.X_CB, swung(frame)), way_px(scene, seen.X_CB, turned));
    EXPECT_LT(off_px, 1.2) << "frame " << frame << ": the farthest crossing";
  }
}

}  // namespace
}  // namespace counterpart
