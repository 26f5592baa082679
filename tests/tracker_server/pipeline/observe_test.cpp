#include "tracker_server/pipeline/observe.hpp"

#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "protocol/vocabulary/pose_eigen.hpp"
#include "tests/tracker_server/support/board_picture.hpp"

namespace counterpart {
namespace {

constexpr double degree = std::numbers::pi / 180;

TEST(Observe, GivesPoseAndPiecesOfAGameBoard) {
  test::BoardScene scene;
  scene.camera = test::camera_720x576();
  // From behind the dark side, as the real player sees it.
  scene.X_CB = test::looking_at_board(0.75, 50 * degree, 190 * degree);
  std::string real(50, 'e');
  for (int square = 1; square <= 20; ++square) {
    scene.pieces.push_back({cell_of_square(square, 10)});
    real[static_cast<std::size_t>(square - 1)] = 'b';
  }
  ObserveOptions options;
  options.intrinsics = scene.camera;
  ObserveContext context(options);
  context.expect(real);
  Frame frame;
  frame.image_bgr = test::paint(scene, 2);
  Observation seen;
  for (int i = 0; i < 12; ++i) {
    frame.stamp = {static_cast<FrameId>(i), i * 40'000'000};
    seen = observe(frame, context);
    EXPECT_EQ(seen.pose.stamp, frame.stamp);
  }
  EXPECT_EQ(seen.pose.status, TrackStatus::ok);
  EXPECT_LT(seen.pose.rms_px, 1);
  EXPECT_GT(seen.pose.seen_share, 0.7);
  EXPECT_GT(seen.pose.covariance[0], 0);
  EXPECT_FALSE(seen.debug.lines.empty());
  EXPECT_FALSE(seen.debug.points.empty());
  for (const char* step : {"pose", "view", "pieces"}) EXPECT_TRUE(seen.step_ms.contains(step)) << step;
  ASSERT_TRUE(seen.occupancy);
  EXPECT_FALSE(seen.occupancy->covered);
  EXPECT_GT(seen.occupancy->stable_ns, 0);
  for (int square = 1; square <= 50; ++square) {
    const Cell cell = cell_of_square(square, 10);
    EXPECT_EQ(seen.occupancy->cells[static_cast<std::size_t>(cell.row * 10 + cell.col)].reading,
              square <= 20 ? CellReading::dark : CellReading::empty)
        << "square " << square;
  }
}

// The mirror draws what the mask covers in front of the virtual human: whole squares would cut his hand off in blocks.
TEST(Observe, TheMaskFollowsTheHandAndNotTheSquares) {
  test::BoardScene scene;
  scene.camera = test::camera_720x576();
  scene.X_CB = test::looking_at_board(0.75, 55 * degree, 190 * degree);
  ObserveOptions options;
  options.intrinsics = scene.camera;
  ObserveContext context(options);
  Frame frame;
  const auto next = [&] {
    frame.image_bgr = test::paint(scene, 2);
    ++frame.stamp.frame_id;
    frame.stamp.capture_ns += 40'000'000;
    return observe(frame, context);
  };
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(next().mask);
  const auto hand = [](int x, int y) { return std::hypot(x - 380, (y - 300) / 1.4) < 62; };
  scene.before = [&](int x, int y) -> std::optional<cv::Vec3b> {
    if (hand(x, y)) return cv::Vec3b(120, 150, 215);
    return std::nullopt;
  };
  const Observation seen = next();
  ASSERT_TRUE(seen.mask);
  std::size_t pixel = 0, both = 0, either = 0;
  bool covered = false;
  for (const std::uint32_t run : seen.mask->runs) {
    for (std::uint32_t i = 0; i < run; ++i, ++pixel) {
      const bool is_hand = hand(static_cast<int>(pixel % 720), static_cast<int>(pixel / 720));
      both += covered && is_hand;
      either += covered || is_hand;
    }
    covered = !covered;
  }
  ASSERT_EQ(pixel, 720U * 576U);
  // A square is about 35 pixels wide here; whole squares would agree by two thirds.
  EXPECT_GT(static_cast<double>(both), 0.85 * static_cast<double>(either));
}

TEST(Observe, TheExpectedPiecesTellWhichWayRoundTheBoardLies) {
  test::BoardScene scene;
  scene.camera = test::camera_720x576();
  scene.X_CB = test::looking_at_board(0.75, 50 * degree, 10 * degree);  // from the light side: not the usual one
  std::string real(50, 'e');
  for (int square = 1; square <= 20; ++square) {
    scene.pieces.push_back({cell_of_square(square, 10)});
    real[static_cast<std::size_t>(square - 1)] = 'b';
  }
  ObserveOptions options;
  options.intrinsics = scene.camera;
  ObserveContext context(options);
  context.expect(real);
  Frame frame;
  frame.image_bgr = test::paint(scene, 2);
  Observation seen;
  for (int i = 0; i < 24; ++i) {
    frame.stamp = {static_cast<FrameId>(i), i * 40'000'000};
    seen = observe(frame, context);
  }
  ASSERT_TRUE(seen.occupancy);
  EXPECT_EQ(seen.occupancy->cells[1].reading, CellReading::dark) << "square 1";
  EXPECT_EQ(seen.occupancy->cells[90].reading, CellReading::empty) << "square 46";
}

// Who draws with the intrinsics must be able to keep them: the estimate may wander, what is told stands.
TEST(Observe, AnEstimatedFocalLengthIsToldOnlyWhenItChangesVisibly) {
  test::BoardScene scene;
  scene.camera = test::camera_720x576();
  ObserveOptions options;
  options.read_pieces = false;
  ObserveContext context(options);
  std::map<std::uint32_t, double> told;
  for (int i = 0; i < 10; ++i) {
    scene.X_CB = test::looking_at_board(0.75, (45 + i) * degree, (190 + i) * degree);
    scene.seed = static_cast<unsigned>(i);
    Frame frame;
    frame.image_bgr = test::paint(scene, 1);
    frame.stamp = {static_cast<FrameId>(i), i * 40'000'000};
    const Observation seen = observe(frame, context);
    ASSERT_TRUE(usable(seen.pose));
    EXPECT_EQ(seen.pose.intrinsics_id, seen.intrinsics.id);
    const auto [known, fresh] = told.try_emplace(seen.intrinsics.id, seen.intrinsics.fx);
    EXPECT_EQ(known->second, seen.intrinsics.fx) << "one id, one camera";
    // Pose and intrinsics that are told together put the board where it is seen; one ray a pixel is worth 0.5 px.
    EXPECT_LT(
        test::farthest_crossing_px(scene.board, scene.camera, scene.X_CB, seen.intrinsics, to_eigen(seen.pose.X_CB)),
        0.5);
  }
  for (auto a = told.begin(), b = std::next(told.begin()); b != told.end(); a = b++)
    EXPECT_GT(std::abs(b->second / a->second - 1), 0.003);
}

TEST(Observe, NoBoardIsLostAndReadsNothing) {
  ObserveOptions options;
  options.intrinsics = test::camera_720x576();
  options.intrinsics->fx = std::numeric_limits<double>::quiet_NaN();
  ObserveContext context(options);
  Frame frame;
  frame.image_bgr = cv::Mat(100, 120, CV_8UC3, cv::Scalar(10, 20, 30));
  const Observation seen = observe(frame, context);
  EXPECT_EQ(seen.pose.status, TrackStatus::lost);
  EXPECT_FALSE(seen.occupancy);
  EXPECT_EQ(observe(frame, context).intrinsics.id, seen.intrinsics.id);
}

}  // namespace
}  // namespace counterpart
