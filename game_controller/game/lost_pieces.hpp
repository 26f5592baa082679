// The virtual player's pieces that the game has lost: on their way off the board, lying beside it, or standing on a man
// of his as the crown that makes it a king.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/game.hpp"
#include "protocol/vocabulary/scene.hpp"

namespace counterpart {

// Where the n-th lost piece lies, n from 0: on the table at its owner's right hand, set apart as on the board.
Point3 place_beside_board_B(const BoardGeometry& board, Side owner, int n);

struct LostPiece {
  std::string name;
  Point3 place_B{};         // where it belongs
  Point3 from_B{};          // where it is while it is under way
  bool to_carry = false;    // and no hand has been told yet
  std::uint64_t grasp = 0;  // the command that takes it there; 0: it is there
  bool king = false;        // under way, it is a king: its crown comes with it
  std::string crowns;       // the man that it stands on, or is under way to; empty: it lies beside the board
  std::string rides_on;     // the piece that it lies on beside the board
  int slot = 0;
};

class LostPieces {
 public:
  LostPieces(const BoardGeometry& board, Side owner) : board_(board), owner_(owner) {}

  // Captured on a square: it belongs beside the board from now on, a king's crown on top of it.
  void capture(const std::string& piece, bool king, int square);

  // A man on a square becomes a king: the piece that was lost last belongs on him, if any lies beside the board.
  void crown(const std::string& man, int square);

  // A hand has ended, however: its piece is where it belongs. False if it moved none of these.
  bool ended(std::uint64_t grasp);

  // Everything is where it belongs.
  void settle();

  bool under_way() const;
  bool awaits_crown(const std::string& man) const;

  std::vector<LostPiece>& all() { return pieces_; }

  // As they are to be seen now.
  void show(std::vector<ScenePiece>& scene) const;

 private:
  int free_slot() const;

  BoardGeometry board_;
  Side owner_;
  std::vector<LostPiece> pieces_;
};

}  // namespace counterpart
