// How much of the board the camera cannot see, by geometry.
#pragma once

#include "stage/player/world.hpp"
#include "vhd_renderer/draw/view.hpp"

namespace counterpart::stage {

struct Hidden {
  double surface_by_arm = 0;  // share of the playing surface behind the arm or a newspaper, 0..1
  double edges = 0;  // share of the outline and the grid lines that is behind the arm, a newspaper or a piece, or
                     // outside the picture
};

Hidden hidden_shares(const World& world, const View& view);

}  // namespace counterpart::stage
