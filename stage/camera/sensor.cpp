#include "stage/camera/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgcodecs.hpp>
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

// The picture's numbers are square roots of light.
void amplify(cv::Mat& bgr, const cv::Vec3d& gain) {
  cv::Mat table(1, 256, CV_8UC3);
  for (int value = 0; value < 256; ++value) {
    for (int c = 0; c < 3; ++c) {
      table.at<cv::Vec3b>(0, value)[c] = cv::saturate_cast<std::uint8_t>(value * std::sqrt(gain[c]));
    }
  }
  cv::LUT(bgr, table, bgr);
}

// Shot noise: the variance grows with the light, so the deviation about doubles from black to white.
// All in 16 bits: value + grain * strength * (160 + value) / 2^18, rounded.
std::int16_t grainy(int value, int grain, int strength) {
  const int gained = (((160 + value) * 64) * (grain * 256)) >> 16;
  return static_cast<std::int16_t>(value + ((((gained * 16 * strength) >> 16) + 8) >> 4));
}

void add_noise(std::uint8_t* row, std::size_t count, const std::int8_t* grain, int strength) {
  std::size_t i = 0;
#if CV_SIMD128
  const auto base = cv::v_setall_s16(160);
  const auto factor = cv::v_setall_s16(static_cast<std::int16_t>(16 * strength));
  const auto half = cv::v_setall_s16(8);
  const auto part = [&](const cv::v_int16x8& value, const cv::v_int16x8& grains) {
    const auto gained = cv::v_mul_hi(cv::v_shl<6>(value + base), cv::v_shl<8>(grains));
    return value + cv::v_shr<4>(cv::v_mul_hi(gained, factor) + half);
  };
  for (; i + 16 <= count; i += 16) {
    cv::v_uint16x8 low, high;
    cv::v_int16x8 grain_low, grain_high;
    cv::v_expand(cv::v_load(row + i), low, high);
    cv::v_expand(cv::v_load(grain + i), grain_low, grain_high);
    cv::v_store(row + i, cv::v_pack_u(part(cv::v_reinterpret_as_s16(low), grain_low),
                                      part(cv::v_reinterpret_as_s16(high), grain_high)));
  }
#endif
  for (; i < count; ++i) {
    row[i] = static_cast<std::uint8_t>(std::clamp<int>(grainy(row[i], grain[i], strength), 0, 255));
  }
}

}  // namespace

cv::Vec3d drift_gain(const SensorOptions& options, double t_s) {
  const double phase = 2 * 3.14159265358979 * t_s / options.drift_period_s;
  const double exposure = std::exp2(options.exposure_drift_ev * std::sin(phase));
  const double warm = options.white_drift * std::sin(0.73 * phase);
  return {exposure * (1 - warm), exposure, exposure * (1 + warm)};
}

void expose(cv::Mat& bgr, const SensorOptions& options, std::uint64_t seed, std::uint64_t frame,
            const cv::Vec3d& gain) {
  if (options.blur_px > 0) {
    const int reach = std::max(1, static_cast<int>(std::ceil(1.7 * options.blur_px)));
    cv::GaussianBlur(bgr, bgr, cv::Size(2 * reach + 1, 2 * reach + 1), options.blur_px, options.blur_px,
                     cv::BORDER_REPLICATE);
  }
  if (gain != cv::Vec3d(1, 1, 1)) amplify(bgr, gain);
  if (options.noise > 0) {
    const std::vector<std::int8_t>& stock = grain_stock();
    const auto bytes = static_cast<std::size_t>(bgr.cols) * 3;
    // 32 grain units are one deviation; 288 is the gain of mid grey.
    const int strength = static_cast<int>(std::lround(options.noise * 262144.0 / (32.0 * 288.0)));
    cv::RNG random((seed + 1) * 0x9E3779B97F4A7C15u + frame * 0xD1B54A32D192ED03u);
    for (int row = 0; row < bgr.rows; ++row) {
      add_noise(bgr.ptr(row), bytes, stock.data() + random.next() % kGrains, strength);
    }
  }
  if (options.jpeg_quality > 0) {
    std::vector<std::uint8_t> squeezed;
    cv::imencode(".jpg", bgr, squeezed, {cv::IMWRITE_JPEG_QUALITY, options.jpeg_quality});
    bgr = cv::imdecode(squeezed, cv::IMREAD_COLOR);
  }
}

}  // namespace counterpart::stage
