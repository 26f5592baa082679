#include "stage/room/warp.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace counterpart::stage {

double warp_height_m(const Warp& warp, double x_m, double y_m) {
  if (warp.height_m == 0) return 0;
  std::mt19937_64 random(warp.seed);
  const auto drawn = [&] { return static_cast<double>(random() >> 11) / 9007199254740992.0 * 2 - 1; };
  const double along_x = drawn(), along_y = drawn(), twist = drawn();
  const double u = std::clamp(x_m / warp.half_m, -1.0, 1.0), v = std::clamp(y_m / warp.half_m, -1.0, 1.0);
  // Legendre polynomials: each is at right angles to any plane over the square.
  const auto bulge = [](double t) { return 1.5 * t * t - 0.5; };
  const double most = std::abs(along_x) + std::abs(along_y) + std::abs(twist);
  return warp.height_m * (along_x * bulge(u) + along_y * bulge(v) + twist * u * v) / most;
}

}  // namespace counterpart::stage
