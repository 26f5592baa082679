// How much of the board the camera cannot see, by geometry.
#pragma once

#include "stage/player/world.hpp"
#include "vhd_renderer/draw/view.hpp"

namespace counterpart::stage {

struct Hidden {
  double surface_by_arm = 0;  // share of the playing surface behind the arm or a newspaper, 0..1
  double edges = 0;  // share of the outline and the grid lines that is behind the arm, a newspaper, an object or a
                     // piece, or outside the picture
};

// Share of the edges of an object that could be seen (a face of theirs looks here) but are behind the arm, a newspaper,
// the table or another object, or outside the picture.
double object_edges_hidden(const World& world, std::size_t object, const View& view);

Hidden hidden_shares(const World& world, const View& view);

}  // namespace counterpart::stage
