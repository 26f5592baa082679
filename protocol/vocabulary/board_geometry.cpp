#include "protocol/vocabulary/board_geometry.hpp"

#include <cmath>

namespace counterpart {

std::optional<Cell> cell_at_B(const Point3& p_B, const BoardGeometry& board) {
  const double half = board.squares / 2.0;
  const double col = std::floor(p_B[0] / board.square_size_m + half);
  const double row = std::floor(half - p_B[1] / board.square_size_m);
  // Compared as doubles: NaN and huge values never reach the conversion to int.
  if (!(col >= 0 && col < board.squares && row >= 0 && row < board.squares)) return std::nullopt;
  return Cell{static_cast<int>(row), static_cast<int>(col)};
}

}  // namespace counterpart
