#include "protocol/vocabulary/board_geometry.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace counterpart {
namespace {

TEST(BoardGeometry, SquareOneIsAtTheTopLeftAndTheLongDiagonalEndsIn5And46) {
  EXPECT_EQ(cell_of_square(1, 10), (Cell{0, 1}));
  EXPECT_EQ(cell_of_square(5, 10), (Cell{0, 9}));
  EXPECT_EQ(cell_of_square(6, 10), (Cell{1, 0}));
  EXPECT_EQ(cell_of_square(46, 10), (Cell{9, 0}));
  EXPECT_EQ(cell_of_square(50, 10), (Cell{9, 8}));
  EXPECT_EQ(cell_of_square(32, 8), (Cell{7, 6}));
}

TEST(BoardGeometry, NumbersCellsAndPlacesAgreeBothWays) {
  for (const int n : {8, 10}) {
    BoardGeometry board;
    board.squares = n;
    for (int square = 1; square <= playable_squares(n); ++square) {
      const Cell cell = cell_of_square(square, n);
      EXPECT_EQ(square_of_cell(cell, n), square);
      EXPECT_EQ(cell_at_B(centre_of_square_B(square, board), board), cell);
    }
  }
}

TEST(BoardGeometry, LightSquaresAndPlacesOffTheBoardHaveNoNumber) {
  EXPECT_FALSE(square_of_cell({0, 0}, 10));
  EXPECT_FALSE(square_of_cell({-1, 0}, 10));
  EXPECT_FALSE(square_of_cell({0, 10}, 10));
  const BoardGeometry board;
  EXPECT_FALSE(cell_at_B({0.2001, 0, 0}, board));
  EXPECT_FALSE(cell_at_B({std::numeric_limits<double>::quiet_NaN(), 0, 0}, board));
  EXPECT_FALSE(cell_at_B({1e300, 0, 0}, board));
}

TEST(BoardGeometry, LightSitsAtNegativeY) {
  const BoardGeometry board;
  EXPECT_LT(centre_of_square_B(46, board)[1], 0);
  EXPECT_LT(centre_of_square_B(46, board)[0], 0);
  EXPECT_GT(centre_of_square_B(5, board)[1], 0);
}

}  // namespace
}  // namespace counterpart
