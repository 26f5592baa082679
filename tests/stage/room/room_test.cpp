#include "stage/room/room.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace counterpart::stage {
namespace {

View from_above() {
  View view;
  view.intrinsics = {1, 720, 576, 610, 610, 359.5, 287.5, {}};
  view.X_CB = look_at_X_CB({0, 0.3, 0.9}, {0, 0, 0});
  return view;
}

double brightness(const cv::Mat& picture, const View& view, const Eigen::Vector3d& p_B) {
  const Eigen::Vector2d at = project(view, p_B);
  const cv::Rect patch(static_cast<int>(at.x()) - 2, static_cast<int>(at.y()) - 2, 5, 5);
  const cv::Scalar mean = cv::mean(picture(patch));
  return (mean[0] + mean[1] + mean[2]) / 3;
}

// Square 28 is played on, and the cell to its right is not; on boards that play on the light squares it is the other
// way.
TEST(Room, SquaresHaveTheColourThatTheBoardSays) {
  const View view = from_above();
  for (const SquareColour played : {SquareColour::dark, SquareColour::light}) {
    RoomOptions options;
    options.board.played_on = played;
    World world = starting_world(options.board);
    world.player_present = false;
    world.pieces.clear();
    const cv::Mat picture = Room::furnish(options).value()->picture(world, view);
    const Cell cell = cell_of_square(28, 10);
    const Point3 on = centre_of_cell_B(cell, options.board);
    const Point3 off = centre_of_cell_B({cell.row, cell.col + 1}, options.board);
    const double difference =
        brightness(picture, view, {off[0], off[1], 0}) - brightness(picture, view, {on[0], on[1], 0});
    if (played == SquareColour::dark) {
      EXPECT_GT(difference, 50);
    } else {
      EXPECT_LT(difference, -50);
    }
  }
}

TEST(Room, PiecesAreDarkAndCastShadows) {
  const View view = from_above();
  RoomOptions options;
  options.board.played_on = SquareColour::light;  // so that the square round a piece is bright
  options.light_direction_B = {-0.6f, 0.f, 0.6f};
  World world = starting_world(options.board);
  world.player_present = false;
  world.pieces.resize(1);
  world.pieces[0].p_B = {0.02, 0.02, 0};
  const auto room = Room::furnish(options).value();
  const cv::Mat with_piece = room->picture(world, view);
  world.pieces.clear();
  const cv::Mat without = room->picture(world, view);
  EXPECT_LT(brightness(with_piece, view, {0.02, 0.02, 0.0076}), brightness(without, view, {0.02, 0.02, 0}) - 40);
  const Eigen::Vector3d in_shadow(0.02 + 0.016 + 0.004, 0.02, 0);  // the light comes from -x
  EXPECT_LT(brightness(with_piece, view, in_shadow), 0.9 * brightness(without, view, in_shadow));
}

}  // namespace
}  // namespace counterpart::stage
