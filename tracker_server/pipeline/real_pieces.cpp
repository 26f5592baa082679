#include "tracker_server/pipeline/real_pieces.hpp"

namespace counterpart {

std::string real_pieces(const BoardState& state, bool both_real) {
  if (both_real) return state.squares;
  std::string out = state.squares;
  const char* of_virtual = state.virtual_side == Side::light ? "wW" : "bB";
  for (char& square : out) {
    if (square == of_virtual[0] || square == of_virtual[1]) square = 'e';
  }
  // Captured real pieces stand there until the player has taken them off.
  const char real_man = state.virtual_side == Side::light ? 'b' : 'w';
  for (const int square : state.to_remove) {
    const auto index = static_cast<std::size_t>(square - 1);
    if (index < out.size()) out[index] = real_man;
  }
  return out;
}

}  // namespace counterpart
