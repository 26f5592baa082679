// The camera's internal parameters: OpenCV's pinhole model with five distortion coefficients.
#pragma once

#include <array>
#include <cstdint>

namespace counterpart {

struct Intrinsics {
  std::uint32_t id = 0;  // changes with every change of the numbers below
  int width = 0;         // pixels
  int height = 0;
  double fx = 0, fy = 0;         // pixels
  double cx = 0, cy = 0;         // pixels; the centre of the first pixel is (0, 0)
  std::array<double, 5> dist{};  // k1, k2, p1, p2, k3

  friend bool operator==(const Intrinsics&, const Intrinsics&) = default;
};

}  // namespace counterpart
