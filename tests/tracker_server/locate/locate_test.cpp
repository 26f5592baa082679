#include "tracker_server/locate/locate.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/tracker_server/support/board_picture.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

using test::BoardScene;
using test::looking_at_board;

constexpr double degree = std::numbers::pi / 180;

// The largest distance from the true outer corners, whichever corner comes first.
double corner_error_px(const BoardScene& scene, const LocatedBoard& located) {
  const double half = 0.5 * scene.board.squares * scene.board.square_size_m;
  const auto corners = located.corners(scene.board.squares);
  double best = std::numeric_limits<double>::max();
  for (std::size_t turn = 0; turn < 4; ++turn) {
    double worst = 0;
    std::size_t i = turn;
    for (const auto& [x, y] : {std::pair{-half, half}, {half, half}, {half, -half}, {-half, -half}})
      worst = std::max(worst, (corners[i++ % 4] - project(scene.camera, scene.X_CB * Eigen::Vector3d(x, y, 0))).norm());
    best = std::min(best, worst);
  }
  return best;
}

BoardScene scene_with_pieces(int squares) {
  BoardScene scene;
  scene.camera = test::camera_720x576();
  scene.board.squares = squares;
  scene.pieces = test::start_position(scene.board);
  return scene;
}

// Corners are extrapolated one square beyond the crossings seen: a third of a pixel is what that leaves.
constexpr double corner_px = 0.35;

TEST(Locate, FindsBoardsWithPiecesFromManySides) {
  for (int squares : {8, 10})
    for (const auto& [elevation, azimuth] : {std::pair{85.0, 20.0}, {55.0, 0.0}, {40.0, 35.0}, {48.0, 200.0}}) {
      BoardScene scene = scene_with_pieces(squares);
      scene.X_CB = looking_at_board(0.8, elevation * degree, azimuth * degree);
      const auto located = locate_board(test::paint(scene, 2), squares);
      ASSERT_TRUE(located) << squares << " squares from " << elevation << ", " << azimuth;
      EXPECT_LT(corner_error_px(scene, *located), corner_px) << squares << " from " << elevation << ", " << azimuth;
    }
}

TEST(Locate, RefusesAPartOfALargerBoard) {
  BoardScene scene = scene_with_pieces(10);
  scene.pieces.clear();
  scene.X_CB = looking_at_board(0.8, 60 * degree, 0.2);
  EXPECT_FALSE(locate_board(test::paint(scene, 2), 8)) << "a 10x10 board is no 8x8 board";
}

TEST(Locate, RefusesPicturesWithoutABoard) {
  cv::Mat noise(480, 640, CV_8UC3);
  cv::RNG random(3);
  random.fill(noise, cv::RNG::NORMAL, 128, 50);
  EXPECT_FALSE(locate_board(noise, 10));
  EXPECT_FALSE(locate_board(cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(0)), 10));
  EXPECT_FALSE(locate_board(cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(9)), 8));
}

TEST(Locate, ABoardThatReachesOutOfThePictureIsNotGuessed) {
  BoardScene scene = scene_with_pieces(10);
  scene.X_CB = looking_at_board(0.3, 80 * degree, 0);  // larger than the picture
  EXPECT_FALSE(locate_board(test::paint(scene, 2), 10));
}

TEST(Locate, CornersGivenInAnyOrderAreMadeExact) {
  BoardScene scene = scene_with_pieces(10);
  scene.X_CB = looking_at_board(0.8, 50 * degree, 0.4);
  const cv::Mat picture = test::paint(scene, 2);
  std::array<Eigen::Vector2d, 4> corners;
  const std::array<std::pair<double, double>, 4> mixed = {{{0.2, 0.2}, {-0.2, -0.2}, {-0.2, 0.2}, {0.2, -0.2}}};
  for (std::size_t i = 0; i < 4; ++i)
    corners[i] = project(scene.camera, scene.X_CB * Eigen::Vector3d(mixed[i].first, mixed[i].second, 0)) +
                 Eigen::Vector2d(2, -3);
  const auto located = board_at_corners(build_pyramid(picture, 4), corners, 10);
  ASSERT_TRUE(located);
  EXPECT_LT(corner_error_px(scene, *located), corner_px);
  corners[1] = corners[0];
  EXPECT_FALSE(board_at_corners(build_pyramid(picture, 4), corners, 10)) << "two corners in one place";
}

}  // namespace
}  // namespace counterpart
