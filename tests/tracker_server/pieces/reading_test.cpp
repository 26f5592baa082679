// Both ways of reading the squares, against pictures whose pieces are known.
#include <map>
#include <numbers>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/tracker_server/support/board_picture.hpp"
#include "tracker_server/pieces/appearance.hpp"
#include "tracker_server/pieces/piece_reader.hpp"
#include "tracker_server/pieces/scan_segments.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

using test::BoardScene;

constexpr double degree = std::numbers::pi / 180;

BoardScene game_scene() {
  BoardScene scene;
  scene.camera = test::camera_720x576();
  scene.X_CB = test::looking_at_board(0.75, 52 * degree, 10 * degree);
  return scene;
}

BoardToPixel to_pixel(const BoardScene& scene) {
  const double D = scene.board.square_size_m, half = 0.5 * scene.board.squares * D;
  return [scene, D, half](double column, double row) -> Eigen::Vector2d {
    return project(scene.camera, scene.X_CB * Eigen::Vector3d(column * D - half, half - row * D, 0));
  };
}

std::map<int, CellReading> truth(const BoardScene& scene) {
  std::map<int, CellReading> readings;
  for (const auto& piece : scene.pieces)
    readings[piece.cell.row * scene.board.squares + piece.cell.col] =
        piece.colour_bgr[1] < 128 ? CellReading::dark : CellReading::light;
  return readings;
}

int wrong_cells(const BoardScene& scene, const std::vector<CellSight>& cells) {
  const auto readings = truth(scene);
  int wrong = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto there = readings.find(static_cast<int>(i));
    wrong += cells[i].reading != (there == readings.end() ? CellReading::empty : there->second);
  }
  return wrong;
}

TEST(Appearance, ReadsTheStartPosition) {
  BoardScene scene = game_scene();
  scene.pieces = test::start_position(scene.board);
  const BoardView view = view_board(test::paint(scene, 2), 10, to_pixel(scene));
  EXPECT_EQ(wrong_cells(scene, read_appearance(look_at_cells(view), 10, {1}).cells), 0);
  EXPECT_EQ(read_appearance(look_at_cells(view), 10, {}).look.playable_parity, 1);
}

TEST(Appearance, ReadsDarkPiecesOnDarkSquares) {
  BoardScene scene = game_scene();
  for (int square : {3, 7, 18, 22, 31, 44}) scene.pieces.push_back({cell_of_square(square, 10), {38, 55, 80}});
  const BoardView view = view_board(test::paint(scene, 2), 10, to_pixel(scene));
  EXPECT_EQ(wrong_cells(scene, read_appearance(look_at_cells(view), 10, {1}).cells), 0);
}

TEST(Appearance, AnEmptyBoardIsEmpty) {
  const BoardScene scene = game_scene();
  const BoardView view = view_board(test::paint(scene, 2), 10, to_pixel(scene));
  EXPECT_EQ(wrong_cells(scene, read_appearance(look_at_cells(view), 10, {1}).cells), 0);
}

// Hue tells two colours of equal brightness apart, whatever the light does to single pieces.
TEST(Appearance, TellsTealFromPurpleWhenTwoStandInTheLight) {
  BoardScene scene = game_scene();
  scene.board.played_on = SquareColour::light;
  for (int square = 1; square <= 12; ++square) scene.pieces.push_back({cell_of_square(square, 10), {60, 66, 30}});
  for (int square = 39; square <= 50; ++square)
    scene.pieces.push_back({cell_of_square(square, 10), square < 41 ? cv::Vec3b(150, 70, 130) : cv::Vec3b(75, 28, 55)});
  const BoardView view = view_board(test::paint(scene, 2), 10, to_pixel(scene));
  const auto cells = read_appearance(look_at_cells(view), 10, {1}).cells;
  const auto at = [&](int square) {
    const Cell cell = cell_of_square(square, 10);
    return cells[static_cast<std::size_t>(cell.row * 10 + cell.col)].reading;
  };
  for (int square = 1; square <= 12; ++square) EXPECT_EQ(at(square), at(1)) << square;
  for (int square = 39; square <= 50; ++square) EXPECT_EQ(at(square), at(50)) << square;
  EXPECT_NE(at(1), at(50));
}

TEST(ScanSegments, ReadsDarkPiecesOnLightSquares) {
  BoardScene scene = game_scene();
  scene.board.played_on = SquareColour::light;
  for (int square : {1, 6, 12, 23, 28, 39, 50}) scene.pieces.push_back({cell_of_square(square, 10)});
  cv::Mat1b grey;
  cv::cvtColor(test::paint(scene, 2), grey, cv::COLOR_BGR2GRAY);
  const auto values = scan_values(grey, 10, to_pixel(scene));
  const auto rule = scan_rule(values, 10, "");
  ASSERT_TRUE(rule);
  EXPECT_EQ(wrong_cells(scene, read_scan(values, 10, rule->threshold, true)), 0);
}

TEST(ScanSegments, AKnownSetUpGivesTheThreshold) {
  std::vector<double> values(100, 200);
  std::string expected(50, 'e');
  for (int square : {1, 2, 3, 4}) {
    const Cell cell = cell_of_square(square, 10);
    values[static_cast<std::size_t>(cell.row * 10 + cell.col)] = 100;
    expected[static_cast<std::size_t>(square - 1)] = 'b';
  }
  const auto rule = scan_rule(values, 10, expected);
  ASSERT_TRUE(rule);
  EXPECT_DOUBLE_EQ(rule->threshold, 150);
  EXPECT_TRUE(rule->pieces_dark);
  for (double& value : values) value = 300 - value;
  EXPECT_FALSE(scan_rule(values, 10, expected)->pieces_dark) << "light pieces on dark squares";
}

TEST(PieceReader, BelievesOnlyWhatStays) {
  BoardScene scene = game_scene();
  scene.pieces = {{cell_of_square(20, 10)}, {cell_of_square(33, 10)}, {cell_of_square(41, 10)}};
  const BoardView before = view_board(test::paint(scene, 2), 10, to_pixel(scene));
  scene.pieces[0].cell = cell_of_square(25, 10);
  const BoardView after = view_board(test::paint(scene, 2), 10, to_pixel(scene));

  PieceReader reader(10);
  FrameStamp stamp;
  const auto next = [&](const BoardView& view) {
    const auto reading = reader.read(view, stamp);
    ++stamp.frame_id;
    stamp.capture_ns += 40'000'000;
    return reading.occupancy;
  };
  Occupancy seen;
  for (int i = 0; i < 6; ++i) seen = next(before);
  const Cell from = cell_of_square(20, 10), to = cell_of_square(25, 10);
  const auto at = [&](Cell cell) { return seen.cells[static_cast<std::size_t>(cell.row * 10 + cell.col)].reading; };
  EXPECT_EQ(at(from), CellReading::dark);
  EXPECT_GT(seen.stable_ns, 0);
  seen = next(after);
  EXPECT_EQ(at(from), CellReading::dark) << "one picture is not believed";
  for (int i = 0; i < 3; ++i) seen = next(after);
  EXPECT_EQ(at(from), CellReading::empty);
  EXPECT_EQ(at(to), CellReading::dark);
}

// A third of a second: what stands there is believed.
void read_eight_times(PieceReader& reader, const BoardView& view, FrameStamp& stamp) {
  for (int i = 0; i < 8; ++i) {
    stamp.capture_ns += 40'000'000;
    reader.read(view, stamp);
  }
}

TEST(PieceReader, FewPiecesTellThatTheBoardIsTurnedRound) {
  BoardScene scene = game_scene();
  const std::vector<int> stand_on = {3, 14, 22, 36, 45, 50};
  std::string as_seen(50, 'e'), turned(50, 'e'), three_taken;
  for (const int square : stand_on) {
    scene.pieces.push_back({cell_of_square(square, 10)});
    as_seen[static_cast<std::size_t>(square - 1)] = 'w';
    turned[static_cast<std::size_t>(50 - square)] = 'w';
  }
  three_taken = as_seen;
  three_taken[10] = three_taken[30] = three_taken[40] = 'w';
  const BoardView view = view_board(test::paint(scene, 2), 10, to_pixel(scene));
  PieceReader reader(10);
  FrameStamp stamp;
  read_eight_times(reader, view, stamp);
  reader.expect(turned);
  EXPECT_TRUE(reader.looks_turned_round());
  reader.expect(as_seen);
  EXPECT_FALSE(reader.looks_turned_round());
  reader.expect(three_taken);
  EXPECT_FALSE(reader.looks_turned_round()) << "three pieces taken away are no turn";
}

TEST(PieceReader, TimeWithoutPicturesIsNotTimeWithoutChange) {
  BoardScene scene = game_scene();
  scene.pieces = {{cell_of_square(20, 10)}, {cell_of_square(33, 10)}};
  const BoardView view = view_board(test::paint(scene, 2), 10, to_pixel(scene));
  PieceReader reader(10);
  FrameStamp stamp;
  read_eight_times(reader, view, stamp);
  stamp.capture_ns += 40'000'000;
  EXPECT_GE(reader.read(view, stamp).occupancy.stable_ns, 200'000'000);
  stamp.capture_ns += 2'000'000'000;
  EXPECT_EQ(reader.read(view, stamp).occupancy.stable_ns, 0) << "the board was out of the picture";
}

TEST(PieceReader, NothingIsGuessedUnderAHand) {
  BoardScene scene = game_scene();
  scene.pieces = {{cell_of_square(20, 10)}, {cell_of_square(33, 10)}};
  PieceReader reader(10);
  FrameStamp stamp;
  const BoardView clear = view_board(test::paint(scene, 2), 10, to_pixel(scene));
  for (int i = 0; i < 5; ++i) {
    stamp.capture_ns += 40'000'000;
    EXPECT_FALSE(reader.read(clear, stamp).occupancy.covered);
  }
  scene.before = [](int x, int y) -> std::optional<cv::Vec3b> {
    if (x > 330 && x < 450 && y > 250) return cv::Vec3b(120, 150, 215);
    return std::nullopt;
  };
  stamp.capture_ns += 40'000'000;
  const auto reading = reader.read(view_board(test::paint(scene, 2), 10, to_pixel(scene)), stamp);
  EXPECT_TRUE(reading.occupancy.covered);
  EXPECT_EQ(reading.occupancy.stable_ns, 0);
  int unknown = 0;
  for (const auto& cell : reading.occupancy.cells) unknown += cell.reading == CellReading::unknown;
  EXPECT_GT(unknown, 6);
}

// So much is hidden that the hidden squares are as usual as the others.
TEST(PieceReader, AnArmOverHalfTheBoardIsNoBoard) {
  BoardScene scene = game_scene();
  for (int square = 1; square <= 20; ++square) scene.pieces.push_back({cell_of_square(square, 10)});
  PieceReader reader(10);
  reader.expect(std::string(20, 'b') + std::string(30, 'e'));
  FrameStamp stamp;
  const BoardView clear = view_board(test::paint(scene, 2), 10, to_pixel(scene));
  for (int i = 0; i < 8; ++i) {
    stamp.capture_ns += 40'000'000;
    EXPECT_FALSE(reader.read(clear, stamp).occupancy.covered);
  }
  // A blue sleeve and the shadow beside it.
  scene.before = [](int x, int y) -> std::optional<cv::Vec3b> {
    if (x > 330 && x < 480 && y > 120) return cv::Vec3b(90, 55, 45);
    if (x > 210 && x <= 330 && y > 120) return cv::Vec3b(75, 85, 100);
    return std::nullopt;
  };
  const BoardView hidden = view_board(test::paint(scene, 2), 10, to_pixel(scene));
  for (int i = 0; i < 8; ++i) {
    stamp.capture_ns += 40'000'000;
    EXPECT_TRUE(reader.read(hidden, stamp).occupancy.covered);
  }
}

TEST(PieceReader, BothSidesPiecesKeepTheirColours) {
  BoardScene scene = game_scene();
  scene.pieces = test::start_position(scene.board);
  PieceReader reader(10);
  reader.expect(std::string(20, 'b') + std::string(10, 'e') + std::string(20, 'w'));
  FrameStamp stamp;
  Occupancy seen;
  const auto look = [&](int pictures) {
    const BoardView view = view_board(test::paint(scene, 2), 10, to_pixel(scene));
    for (int i = 0; i < pictures; ++i) {
      stamp.capture_ns += 40'000'000;
      seen = reader.read(view, stamp).occupancy;
    }
  };
  look(8);
  EXPECT_EQ(wrong_cells(scene, seen.cells), 0);
  // A light man takes a dark one's square.
  const Cell from = cell_of_square(31, 10), to = cell_of_square(20, 10);
  std::erase_if(scene.pieces, [&](const test::PaintedPiece& piece) { return piece.cell == to; });
  for (test::PaintedPiece& piece : scene.pieces)
    if (piece.cell == from) piece.cell = to;
  look(4);
  EXPECT_EQ(wrong_cells(scene, seen.cells), 0);
}

// The camera turns away until only a strip of the board is left, and back after a while.
TEST(PieceReader, AStripOfTheBoardTeachesNothing) {
  BoardScene scene = game_scene();
  for (int square = 1; square <= 20; ++square) scene.pieces.push_back({cell_of_square(square, 10)});
  PieceReader reader(10);
  reader.expect(std::string(20, 'b') + std::string(30, 'e'));
  FrameStamp stamp;
  const BoardView whole = view_board(test::paint(scene, 2), 10, to_pixel(scene));
  BoardView strip = whole;
  for (int row = 0; row < 10; ++row)
    for (int col = 0; col < 7; ++col) strip.cells[static_cast<std::size_t>(row * 10 + col)] = {};
  Occupancy seen;
  const auto look = [&](const BoardView& view, int pictures) {
    for (int i = 0; i < pictures; ++i) {
      stamp.capture_ns += 40'000'000;
      seen = reader.read(view, stamp).occupancy;
    }
  };
  look(whole, 8);
  EXPECT_EQ(wrong_cells(scene, seen.cells), 0);
  look(strip, 150);
  look(whole, 8);
  EXPECT_EQ(wrong_cells(scene, seen.cells), 0);
}

}  // namespace
}  // namespace counterpart
