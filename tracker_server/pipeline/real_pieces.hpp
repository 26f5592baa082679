// What the camera should see on the board: the real player's pieces of a position, nothing virtual.
#pragma once

#include <string>

#include "protocol/vocabulary/game.hpp"

namespace counterpart {

// One of "wbWBe" a square in order of number; the virtual side's pieces are 'e' unless they are real too.
std::string real_pieces(const BoardState& state, bool both_real = false);

}  // namespace counterpart
