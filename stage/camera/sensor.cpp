#include "stage/camera/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace counterpart::stage {
namespace {

constexpr std::size_t kGrains = 1 << 20;  // a stock of grain; each row starts somewhere else in it

const std::vector<std::int8_t>& grain_stock() {
  static const std::vector<std::int8_t> stock = [] {
    std::vector<std::int8_t> made(kGrains + (1 << 16));
    cv::RNG random(20000612);
    for (std::int8_t& grain : made) {
      grain = static_cast<std::int8_t>(std::clamp(std::lround(random.gaussian(32)), -127L, 127L));
    }
    return made;
  }();
  return stock;
}

// Shot noise: the variance grows with the light, so the deviation about doubles from black to white.
void add_noise(std::uint8_t* row, std::size_t count, const std::int8_t* grain, int strength) {
  for (std::size_t i = 0; i < count; ++i) {
    const int gain = strength * (160 + row[i]);
    const int value = row[i] + ((grain[i] * gain + (1 << 17)) >> 18);
    row[i] = static_cast<std::uint8_t>(std::clamp(value, 0, 255));
  }
}

}  // namespace

void expose(cv::Mat& bgr, const SensorOptions& options, std::uint64_t seed, std::uint64_t frame) {
  if (options.blur_px > 0) {
    const int reach = std::max(1, static_cast<int>(std::ceil(2 * options.blur_px)));
    cv::GaussianBlur(bgr, bgr, cv::Size(2 * reach + 1, 2 * reach + 1), options.blur_px, options.blur_px,
                     cv::BORDER_REPLICATE);
  }
  if (options.noise <= 0) return;
  const std::vector<std::int8_t>& stock = grain_stock();
  const auto bytes = static_cast<std::size_t>(bgr.cols) * 3;
  // 32 grain units are one deviation; 288 is the gain of mid grey.
  const int strength = static_cast<int>(std::lround(options.noise * 262144.0 / (32.0 * 288.0)));
  cv::RNG random((seed + 1) * 0x9E3779B97F4A7C15u + frame * 0xD1B54A32D192ED03u);
  for (int row = 0; row < bgr.rows; ++row) {
    add_noise(bgr.ptr(row), bytes, stock.data() + random.next() % kGrains, strength);
  }
}

}  // namespace counterpart::stage
