// How the room's surfaces look, as GLSL for Renderer::add_surface.
#pragma once

#include <string>

namespace counterpart::stage {

// parameters: squares a side, square size in metres, 1 if the dark squares are played on. Squares and rim are computed,
// not painted, so their edges lie exactly where the truth says at every distance.
std::string board_surface();
std::string table_surface();
std::string floor_surface();
std::string wall_surface();
std::string wooden_piece_surface();
std::string skin_surface();

}  // namespace counterpart::stage
