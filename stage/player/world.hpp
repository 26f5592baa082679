// What stands and moves in the simulated room at one moment. Frame B, metres.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "protocol/vocabulary/board_geometry.hpp"
#include "stage/room/room_object.hpp"

namespace counterpart::stage {

struct RealPiece {
  int square = 0;  // where it stands; 0: beside the board or in the hand
  bool king = false;
  Eigen::Vector3d p_B{0, 0, 0};  // centre of its foot
  double turn_rad = 0;           // how it happens to be turned round its axis
  double roll_rad = 0;           // of a piece that is knocked over: half a turn is upside down
};

struct HandState {
  Eigen::Vector3d pinch_B{0, 0, 0};  // between the finger tips
  int held_piece = -1;               // index into World::pieces
};

// A sheet of paper that somebody holds over the board.
struct Sheet {
  Eigen::Isometry3d X_BS = Eigen::Isometry3d::Identity();  // S: origin at its middle, z out of it
  double size_x_m = 0.5, size_y_m = 0.5;
};

struct SeatedPose;

// Frame R is the room's: that of the board where it first lay.
struct World {
  BoardGeometry board;
  Eigen::Isometry3d X_RB = Eigen::Isometry3d::Identity();  // upright: the board lies on the table
  double light = 1;                                        // 1: a bright day, 0: dark
  std::optional<Eigen::Vector3d> cup_R;                    // a coffee cup's foot
  std::optional<Sheet> sheet;
  std::vector<RealPiece> pieces;
  std::vector<RoomObject> objects;
  bool board_present = true;
  bool player_present = true;
  HandState hand;
  std::shared_ptr<const SeatedPose> seated;  // the whole player; null: his arm alone is seen
};

// Moves the board with what stands on it; what lies beside it stays where it is in the room.
void move_board(World& world, const Eigen::Isometry3d& X_RB);

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
