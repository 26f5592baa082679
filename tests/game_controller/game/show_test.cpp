#include "game_controller/game/show.hpp"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace counterpart {
namespace {

Occupancy board_with(const std::vector<Cell>& pieces, int squares = 8) {
  Occupancy sight;
  sight.squares = squares;
  sight.cells.assign(static_cast<std::size_t>(squares * squares), {CellReading::empty, 1.0f});
  for (const Cell& cell : pieces) {
    sight.cells[static_cast<std::size_t>(cell.row * squares + cell.col)].reading = CellReading::piece;
  }
  return sight;
}

BoardGeometry eight() {
  BoardGeometry board;
  board.squares = 8;
  return board;
}

std::vector<Grasp> grasps_of(const Show& show) {
  std::vector<Grasp> out;
  for (const Command& command : show.commands) {
    if (const auto* grasp = std::get_if<Grasp>(&command.action)) out.push_back(*grasp);
  }
  return out;
}

TEST(Show, PointsAtThePieceNearestToTheHuman) {
  const auto show = plan_show(board_with({{0, 1}, {5, 2}, {2, 7}}), eight(), Side::light, 0.74);
  ASSERT_TRUE(show);
  const auto grasps = grasps_of(*show);
  ASSERT_FALSE(grasps.empty());
  EXPECT_EQ(grasps[0].piece, "");
  EXPECT_EQ(cell_at_B(grasps[0].path_B.back(), eight()), (Cell{5, 2}));
}

TEST(Show, SetsTheVirtualPieceDownOnAnEmptySquareAndMovesItToAnother) {
  const Occupancy sight = board_with({{0, 1}, {5, 2}, {6, 5}});
  const auto show = plan_show(sight, eight(), Side::light, 0.74);
  ASSERT_TRUE(show);
  ASSERT_EQ(show->scene.pieces.size(), 4u);  // his own and the three real ones, which hide what is behind them
  EXPECT_TRUE(show->scene.pieces[1].real);
  std::set<std::pair<int, int>> places;
  for (const Grasp& grasp : grasps_of(*show)) {
    if (grasp.piece.empty()) continue;
    EXPECT_EQ(grasp.piece, show->scene.pieces[0].name);
    const auto cell = cell_at_B(grasp.path_B.back(), eight());
    ASSERT_TRUE(cell);
    EXPECT_EQ(sight.cells[static_cast<std::size_t>(cell->row * 8 + cell->col)].reading, CellReading::empty);
    places.insert({cell->row, cell->col});
  }
  EXPECT_EQ(places.size(), 2u);
}

TEST(Show, NothingIsPutWhereTheCameraSeesNothing) {
  Occupancy sight = board_with({});
  for (CellSight& cell : sight.cells) cell.reading = CellReading::unknown;
  EXPECT_FALSE(plan_show(sight, eight(), Side::light, 0.74));
}

TEST(Show, TheDarkSeatIsServedFromTheOtherSide) {
  const auto show = plan_show(board_with({{2, 3}}), eight(), Side::dark, 0.74);
  ASSERT_TRUE(show);
  EXPECT_GT(grasps_of(*show)[1].path_B.back()[1], 0);
}

TEST(Show, IdsAreUniqueAndChainsPointBackwards) {
  const auto show = plan_show(board_with({{3, 3}}), eight(), Side::light, 0.74);
  ASSERT_TRUE(show);
  std::set<std::uint64_t> seen;
  for (const Command& command : show->commands) {
    for (const std::uint64_t before : command.after) EXPECT_TRUE(seen.count(before)) << command.id;
    EXPECT_TRUE(seen.insert(command.id).second);
  }
}

}  // namespace
}  // namespace counterpart
