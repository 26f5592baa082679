// The board as a thing: sizes, and the one conversion between square numbers, cells and the board frame B.
//
// B: origin at the centre of the playing surface, x to the right and y away as the player of the light pieces sees it,
// z up. Cells are (row, col) with row 0 farthest from the light player and col 0 on his left. The squares that are
// played on are those with (row + col) odd, numbered from 1 by rows as the rulebook does (FMJD Annex 1, art. 2.5); on a
// board whose light squares are played on, B is simply laid so that this holds.
#pragma once

#include <cstdint>
#include <optional>

#include "protocol/vocabulary/pose.hpp"

namespace counterpart {

enum class SquareColour : std::uint8_t { dark = 1, light = 2 };

struct BoardGeometry {
  int squares = 10;             // a side: 10 or 8
  double square_size_m = 0.04;  // side of a square
  double border_m = 0.03;       // width of the rim round the playing surface, 0 if none
  double thickness_m = 0.015;   // height of the playing surface above the table
  double piece_radius_m = 0.016;
  double piece_height_m = 0.008;
  SquareColour played_on = SquareColour::dark;

  friend bool operator==(const BoardGeometry&, const BoardGeometry&) = default;
};

struct Cell {
  int row = 0;
  int col = 0;

  friend bool operator==(const Cell&, const Cell&) = default;
};

// Number of squares played on: 50 or 32.
constexpr int playable_squares(int squares_a_side) {
  return squares_a_side * squares_a_side / 2;
}

// square: 1 .. playable_squares(n). No check: callers hold valid numbers (see is_square).
constexpr Cell cell_of_square(int square, int squares_a_side) {
  const int per_row = squares_a_side / 2;
  const int row = (square - 1) / per_row;
  const int col = 2 * ((square - 1) % per_row) + (row % 2 == 0 ? 1 : 0);
  return {row, col};
}

constexpr bool is_square(int square, int squares_a_side) {
  return square >= 1 && square <= playable_squares(squares_a_side);
}

// Empty for cells off the board and for cells that are not played on.
constexpr std::optional<int> square_of_cell(Cell cell, int squares_a_side) {
  const int n = squares_a_side;
  if (cell.row < 0 || cell.row >= n || cell.col < 0 || cell.col >= n) return std::nullopt;
  if ((cell.row + cell.col) % 2 == 0) return std::nullopt;
  return cell.row * (n / 2) + cell.col / 2 + 1;
}

constexpr Point3 centre_of_cell_B(Cell cell, const BoardGeometry& board) {
  const double middle = (board.squares - 1) / 2.0;
  return {(cell.col - middle) * board.square_size_m, (middle - cell.row) * board.square_size_m, 0.0};
}

constexpr Point3 centre_of_square_B(int square, const BoardGeometry& board) {
  return centre_of_cell_B(cell_of_square(square, board.squares), board);
}

// The cell under a point of the playing surface; empty off the surface.
std::optional<Cell> cell_at_B(const Point3& p_B, const BoardGeometry& board);

}  // namespace counterpart
