// Wood works: a board's top is never quite a plane. Its truth stays the plane that fits it best.
#pragma once

#include <cstdint>

namespace counterpart::stage {

struct Warp {
  double height_m = 0;  // by so much the top is off its plane at most
  double half_m = 0.2;  // half a side of the top
  std::uint64_t seed = 1;
};

// Height of the top over its plane at a place on the board, frame B, metres. A bulge along each side and a twist, by
// the seed; no lift and no tilt as a whole. Places beside the board are taken as on its rim.
double warp_height_m(const Warp& warp, double x_m, double y_m);

}  // namespace counterpart::stage
