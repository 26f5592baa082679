// Pictures for the room's surfaces, made by numbers: nothing is loaded. Encoded as screens show them.
#pragma once

#include <cstdint>
#include <vector>

#include "vhd_renderer/body/figure.hpp"

namespace counterpart::stage {

// Straight-grained wood along u, tileable along u; light and dark are the colours of early and late wood (r, g, b;
// 0..255).
Texture wood_texture(int width, int height, const Eigen::Vector3f& light, const Eigen::Vector3f& dark,
                     std::uint64_t seed);

// Grain of the board's fields, different from square to square, over the board with its rim: red for light squares,
// green for dark ones, blue for the rim. squares: a side; rim_share: of the rim in half the side.
Texture board_grain_texture(int size, int squares, double rim_share, std::uint64_t seed);

// Where something stands on the floor and keeps the light off: a rectangle round the middle, from the floor's.
struct FloorShade {
  Eigen::Vector2d middle_m;
  Eigen::Vector2d half_size_m;
};

// The table's top, darker towards its corners, and the floor of 7 x 5 metres with the table's shade on it and the
// window's light.
Texture table_texture(int width, int height, std::uint64_t seed);
Texture floor_texture(int width, int height, std::uint64_t seed, const std::vector<FloorShade>& shades = {});

// The wall behind the far side of the table, slightly out of focus: window, shelf, cupboard, lamp.
Texture wall_texture(int width, int height, std::uint64_t seed);

// A page of a newspaper: headline, columns, a picture.
Texture newspaper_texture(int width, int height, std::uint64_t seed);

// Grey cloth: a fine weave.
Texture cloth_texture(int width, int height, std::uint64_t seed);

}  // namespace counterpart::stage
