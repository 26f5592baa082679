#include "stage/room/warp.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace counterpart::stage {

Warp::Warp(double height_m, double half_m, std::uint64_t seed) : half_m_(half_m) {
  std::mt19937_64 random(seed);
  const auto drawn = [&] { return static_cast<double>(random() >> 11) / 9007199254740992.0 * 2 - 1; };
  const double along_x = drawn(), along_y = drawn(), twist = drawn();
  const double scale = height_m / (std::abs(along_x) + std::abs(along_y) + std::abs(twist));
  along_x_m_ = scale * along_x;
  along_y_m_ = scale * along_y;
  twist_m_ = scale * twist;
}

double Warp::height_m(double x_m, double y_m) const {
  const double u = std::clamp(x_m / half_m_, -1.0, 1.0), v = std::clamp(y_m / half_m_, -1.0, 1.0);
  // Legendre polynomials: each is at right angles to any plane over the square.
  const auto bulge = [](double t) { return 1.5 * t * t - 0.5; };
  return along_x_m_ * bulge(u) + along_y_m_ * bulge(v) + twist_m_ * u * v;
}

}  // namespace counterpart::stage
