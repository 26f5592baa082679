// The moves a simulated player may choose from.
#pragma once

#include <string>
#include <vector>

#include "protocol/vocabulary/game.hpp"

namespace counterpart::stage {

struct PlayerMove {
  std::vector<int> path;  // squares from, via, to
  std::vector<int> captured;
};

// squares: one of "wbWBe" a square, in order of number. Empty if the side cannot move or rules are unknown.
std::vector<PlayerMove> legal_moves(const std::string& rules, const std::string& squares, Side turn);

}  // namespace counterpart::stage
