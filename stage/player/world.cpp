#include "stage/player/world.hpp"

#include <algorithm>
#include <cmath>

namespace counterpart::stage {

void move_board(World& world, const Eigen::Isometry3d& X_RB) {
  const Eigen::Isometry3d X_new_old = X_RB.inverse() * world.X_RB;
  for (std::size_t i = 0; i < world.pieces.size(); ++i) {
    RealPiece& piece = world.pieces[i];
    if (piece.square == 0 && static_cast<int>(i) != world.hand.held_piece) piece.p_B = X_new_old * piece.p_B;
  }
  world.X_RB = X_RB;
}

int piece_on(const World& world, int square) {
  const auto at = std::find_if(world.pieces.begin(), world.pieces.end(),
                               [&](const RealPiece& piece) { return piece.square == square; });
  return at == world.pieces.end() ? -1 : static_cast<int>(at - world.pieces.begin());
}

std::string occupancy_of(const World& world) {
  std::string squares(static_cast<std::size_t>(playable_squares(world.board.squares)), 'e');
  for (const RealPiece& piece : world.pieces) {
    if (piece.square > 0) squares[static_cast<std::size_t>(piece.square - 1)] = piece.king ? 'B' : 'b';
  }
  return squares;
}

World starting_world(const BoardGeometry& board) {
  World world;
  world.board = board;
  const int rows_of_men = board.squares / 2 - 1;
  for (int square = 1; square <= rows_of_men * board.squares / 2; ++square) {
    const Point3 p = centre_of_square_B(square, board);
    // A person does not put pieces down exactly; fixed small offsets will do.
    const double dx = 0.06 * board.square_size_m * std::sin(12.9 * square);
    const double dy = 0.06 * board.square_size_m * std::sin(78.2 * square);
    world.pieces.push_back({square, false, {p[0] + dx, p[1] + dy, 0}, 2.4 * square});
  }
  world.hand.pinch_B = resting_hand(board);
  return world;
}

Eigen::Vector3d place_beside_board(const BoardGeometry& board, int n) {
  const double step = 2.3 * board.piece_radius_m;
  const double edge = board.squares * board.square_size_m / 2 + board.border_m;
  return {-(edge + (1.6 + 2.3 * (n % 3)) * board.piece_radius_m), 0.5 * edge - step * (n / 3), -board.thickness_m};
}

Eigen::Vector3d resting_hand(const BoardGeometry& board) {
  const double edge = board.squares * board.square_size_m / 2 + board.border_m;
  return {-edge - 0.03, edge + 0.10, -board.thickness_m + 0.02};
}

}  // namespace counterpart::stage
