// Curves that people move by.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace counterpart {

inline constexpr float pi_f = std::numbers::pi_v<float>;

constexpr float radians(float degrees) {
  return degrees * pi_f / 180.F;
}

inline float unit_clamp(float x) {
  return std::clamp(x, 0.F, 1.F);
}

// Flash and Hogan 1985: the hand moves from rest to rest with the least jerk. 0..1 -> 0..1.
inline float minimum_jerk(float x) {
  const float u = unit_clamp(x);
  return u * u * u * (10 + u * (-15 + 6 * u));
}

// 0 at both ends with no slope, 1 in the middle.
inline float bump(float x) {
  const float u = unit_clamp(x);
  return 16 * u * u * (1 - u) * (1 - u);
}

// Identity up to `start`, then flattens out towards `limit`; smooth in value and slope.
inline float soft_limit(float x, float start, float limit) {
  if (x <= start) return x;
  const float room = limit - start;
  return start + room * (1 - std::exp(-(x - start) / room));
}

inline float lerp(float a, float b, float t) {
  return a + (b - a) * t;
}

// Smooth noise in -1..1, the same for the same time and seed. `t` in periods.
inline float noise(double t, unsigned seed) {
  const auto at = [seed](long long i) {
    auto h = static_cast<unsigned long long>(i) * 0x9E3779B97F4A7C15ULL + seed * 0xD1B54A32D192ED03ULL;
    h ^= h >> 31U;
    h *= 0x94D049BB133111EBULL;
    h ^= h >> 29U;
    return static_cast<float>(h >> 40U) / 8388608.F - 1.F;
  };
  const double floor = std::floor(t);
  const auto i = static_cast<long long>(floor);
  const float f = static_cast<float>(t - floor);
  return lerp(at(i), at(i + 1), minimum_jerk(f));
}

// Critically damped spring: follows a target without overshoot, exact for any step length.
template <class T>
struct Follower {
  T value{};
  T velocity{};

  void step(const T& target, float time_constant_s, float dt_s) {
    const float w = 2.F / std::max(time_constant_s, 1e-4F);
    const float e = std::exp(-w * dt_s);
    const T offset = value - target;
    const T rate = velocity + offset * w;
    value = target + (offset + rate * dt_s) * e;
    velocity = (velocity - rate * (w * dt_s)) * e;
  }
};

}  // namespace counterpart
