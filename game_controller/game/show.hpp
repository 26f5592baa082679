// A short performance for a board on which nobody plays: the human looks at a real piece and points at it, sets down a
// virtual one on an empty square near him, and moves it on. What he does depends on what the camera has read.
#pragma once

#include <optional>
#include <vector>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/command.hpp"
#include "protocol/vocabulary/occupancy.hpp"
#include "protocol/vocabulary/scene.hpp"

namespace counterpart {

struct Show {
  Scene scene;                    // with the virtual piece lying beside the board
  std::vector<Command> commands;  // chained; ids from 1
};

// `sight`: a reading of the board. Squares that are not surely empty are kept clear of. If no piece is seen he points
// at the middle of the board; empty only if there is no free square at all within his reach.
[[nodiscard]] std::optional<Show> plan_show(const Occupancy& sight, const BoardGeometry& board, Side virtual_side,
                                            double table_height_m);

}  // namespace counterpart
