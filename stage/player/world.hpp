// What stands and moves in the simulated room at one moment. Frame B, metres.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "protocol/vocabulary/board_geometry.hpp"

namespace counterpart::stage {

struct RealPiece {
  int square = 0;  // where it stands; 0: beside the board or in the hand
  bool king = false;
  Eigen::Vector3d p_B{0, 0, 0};  // centre of its foot
  double turn_rad = 0;           // how it happens to be turned round its axis
};

struct HandState {
  Eigen::Vector3d pinch_B{0, 0, 0};  // between the finger tips
  int held_piece = -1;               // index into World::pieces
};

struct World {
  BoardGeometry board;
  std::vector<RealPiece> pieces;
  bool player_present = true;
  HandState hand;
};

// The piece that stands on this square, or -1.
int piece_on(const World& world, int square);

// 'b' or 'B' (a king) for each square in order of number, 'e' where no real piece stands.
std::string occupancy_of(const World& world);

// The real player's pieces on their first squares: 1 to 20 on a 10x10 board, 1 to 12 on an 8x8 one.
World starting_world(const BoardGeometry& board);

// The n-th free place beside the board for pieces that are out of play.
Eigen::Vector3d place_beside_board(const BoardGeometry& board, int n);

// Where the hand rests when nothing is to be done: on the table's edge, beside the board.
Eigen::Vector3d resting_hand(const BoardGeometry& board);

}  // namespace counterpart::stage
