// The making of one endgame table from those of the materials that it leads to.
#pragma once

#include <functional>
#include <optional>

#include "game_controller/engine/endgame.hpp"
#include "game_controller/engine/endgame_index.hpp"

namespace counterpart {

struct SolvedEndgame {
  EndgameBytes bytes;         // of the material
  EndgameBytes turned_bytes;  // of the turned one; empty if that is the same
};

// Empty if give_up said so, or the tables that this one needs are not there.
std::optional<SolvedEndgame> solve_endgame(const EndgameTables& known, const EndgameIndex& index,
                                           const Material& material, const std::function<bool()>& give_up);

}  // namespace counterpart
