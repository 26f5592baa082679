// How the room's surfaces look, as GLSL for Renderer::add_surface.
#pragma once

#include <string>

namespace counterpart::stage {

// Shade::level. parameters: squares a side, square size in metres, 0.5 if the dark squares are played on, else -0.5.
// Squares and rim are computed, not painted, so their edges lie exactly where the truth says at every distance; the
// texture gives the grain.
std::string board_surface();
std::string wooden_piece_surface();
std::string skin_surface();

}  // namespace counterpart::stage
