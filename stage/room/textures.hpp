// Pictures for the room's surfaces, made by numbers: nothing is loaded. Encoded as screens show them.
#pragma once

#include <cstdint>

#include "vhd_renderer/body/figure.hpp"

namespace counterpart::stage {

// Straight-grained wood along u, tileable along u; light and dark are the colours of early and late wood (r, g, b; 0..255).
Texture wood_texture(int width, int height, const Eigen::Vector3f& light, const Eigen::Vector3f& dark,
                     std::uint64_t seed);

// Boards laid side by side along u.
Texture planks_texture(int width, int height, int planks, const Eigen::Vector3f& light, const Eigen::Vector3f& dark,
                       std::uint64_t seed);

// The wall behind the far side of the table, slightly out of focus: window, shelf, cupboard, lamp.
Texture wall_texture(int width, int height, std::uint64_t seed);

// Grey cloth: a fine weave.
Texture cloth_texture(int width, int height, std::uint64_t seed);

}  // namespace counterpart::stage
