// A draughtsman as a turner makes it.
#pragma once

#include "protocol/vocabulary/board_geometry.hpp"
#include "vhd_renderer/draw/mesh.hpp"

namespace counterpart {

// Rounded rims and a ring cut into the upper face; foot at z = 0, centred. segments: round it.
MeshData piece_shape(const BoardGeometry& board, int segments);

}  // namespace counterpart
