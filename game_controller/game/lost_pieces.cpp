#include "game_controller/game/lost_pieces.hpp"

#include <algorithm>

namespace counterpart {

Point3 place_beside_board_B(const BoardGeometry& board, Side owner, int n) {
  constexpr int columns = 2;
  const double D = board.square_size_m;
  const double edge = board.squares * D / 2 + board.border_m;
  const int row = n / columns;
  const double x = edge + (1.0 + 2 * (n % columns) + row % 2) * D;
  const double y = -0.5 * edge + row * D;
  const double side = owner == Side::light ? 1 : -1;
  return {side * x, side * y, -board.thickness_m};
}

int LostPieces::free_slot() const {
  const auto taken = [&](int slot) {
    return std::any_of(pieces_.begin(), pieces_.end(),
                       [&](const auto& one) { return one.crowns.empty() && one.slot == slot; });
  };
  int slot = 0;
  while (taken(slot)) ++slot;
  return slot;
}

void LostPieces::capture(const std::string& piece, bool king, int square) {
  LostPiece lost;
  lost.name = piece;
  lost.slot = free_slot();
  lost.king = king;
  lost.to_carry = true;
  lost.from_B = centre_of_square_B(square, board_);
  lost.place_B = place_beside_board_B(board_, owner_, lost.slot);
  if (king) {
    LostPiece crown;
    const auto worn =
        std::find_if(pieces_.begin(), pieces_.end(), [&](const auto& one) { return one.crowns == piece; });
    crown.name = worn == pieces_.end() ? piece + "_crown" : worn->name;
    crown.slot = lost.slot;
    crown.rides_on = piece;
    crown.place_B = lost.place_B;
    crown.place_B[2] += board_.piece_height_m;
    if (worn != pieces_.end()) pieces_.erase(worn);
    pieces_.push_back(std::move(crown));
  }
  // Before its crown, which lies on it and is taken first.
  pieces_.insert(pieces_.end() - (king ? 1 : 0), std::move(lost));
}

void LostPieces::crown(const std::string& man, int square) {
  const auto lies = [](const LostPiece& one) { return one.crowns.empty() && one.grasp == 0; };
  const auto last = std::find_if(pieces_.rbegin(), pieces_.rend(), lies);
  if (last == pieces_.rend()) return;
  last->crowns = man;
  last->rides_on.clear();
  last->from_B = last->place_B;
  last->place_B = centre_of_square_B(square, board_);
  last->place_B[2] += board_.piece_height_m;
  last->king = false;
  last->to_carry = true;
}

bool LostPieces::ended(std::uint64_t grasp) {
  bool mine = false;
  for (LostPiece& one : pieces_) {
    if (grasp == 0 || one.grasp != grasp) continue;
    one.grasp = 0;
    mine = true;
  }
  return mine;
}

void LostPieces::settle() {
  for (LostPiece& one : pieces_) {
    one.grasp = 0;
    one.to_carry = false;
  }
}

bool LostPieces::under_way() const {
  return std::any_of(pieces_.begin(), pieces_.end(), [](const auto& one) { return one.grasp != 0; });
}

bool LostPieces::awaits_crown(const std::string& man) const {
  return std::any_of(pieces_.begin(), pieces_.end(),
                     [&](const auto& one) { return one.crowns == man && one.grasp != 0; });
}

void LostPieces::show(std::vector<ScenePiece>& scene) const {
  for (const LostPiece& one : pieces_) {
    const bool on_its_way = one.grasp != 0;
    if (!one.crowns.empty() && !on_its_way) continue;  // part of a king
    const auto carrier = std::find_if(pieces_.begin(), pieces_.end(), [&](const auto& other) {
      return other.name == one.rides_on && other.grasp != 0;
    });
    if (carrier != pieces_.end()) continue;
    scene.push_back({one.name, owner_, one.king && on_its_way, false, on_its_way ? one.from_B : one.place_B});
  }
}

}  // namespace counterpart
