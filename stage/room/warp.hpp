// Wood works: a board's top is never quite a plane. Its truth stays the plane that fits it best.
#pragma once

#include <cstdint>

namespace counterpart::stage {

// A bulge along each side and a twist, drawn by the seed; no lift and no tilt as a whole.
class Warp {
 public:
  // A plane.
  Warp() = default;

  // height_m: by so much the top is off its plane at most. half_m: half a side of the top.
  Warp(double height_m, double half_m, std::uint64_t seed);

  // Height of the top over its plane at a place on the board, frame B, metres. Places beside the board are taken as on
  // its rim.
  double height_m(double x_m, double y_m) const;

 private:
  double half_m_ = 1;
  double along_x_m_ = 0, along_y_m_ = 0, twist_m_ = 0;
};

}  // namespace counterpart::stage
