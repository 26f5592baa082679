#include "vhd_renderer/motion/idle.hpp"

#include <cmath>

#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {

void add_idle(double t_s, unsigned seed, float seatedness, BodyControls& c) {
  // 14 breaths a minute; in is shorter than out.
  const double phase = t_s * 14.0 / 60.0;
  const auto part = static_cast<float>(phase - std::floor(phase));
  const float breath = part < 0.4F ? minimum_jerk(part / 0.4F) : 1 - minimum_jerk((part - 0.4F) / 0.6F);
  c.spine.pitch -= radians(1.1F) * breath;
  for (float& shrug : c.shrug) shrug += 0.045F * breath;
  const float sway = 1 - 0.5F * seatedness;
  c.spine.roll += radians(0.9F) * sway * noise(t_s / 3.1, seed);
  c.spine.yaw += radians(0.8F) * noise(t_s / 3.7, seed + 1);
  c.spine.pitch += radians(0.9F) * noise(t_s / 4.3, seed + 2);
  c.pelvis.roll += radians(0.5F) * sway * noise(t_s / 5.3, seed + 3);
  c.head.pitch += radians(1.3F) * noise(t_s / 1.9, seed + 4);
  c.head.roll += radians(1.6F) * noise(t_s / 2.6, seed + 5);
  c.head.yaw += radians(1.4F) * noise(t_s / 2.3, seed + 6);
}

float blink(double t_s, unsigned seed) {
  // One blink in every window of 3.2 s, at a place of its own; the lid closes in 0.07 s and opens in 0.13 s.
  const double window = std::floor(t_s / 3.2);
  const double start = window * 3.2 + 0.2 + 2.6 * 0.5 * (1 + static_cast<double>(noise(window, seed + 11)));
  const auto t = static_cast<float>(t_s - start);
  if (t < 0 || t > 0.22F) return 0;
  return t < 0.07F ? minimum_jerk(t / 0.07F) : 1 - minimum_jerk((t - 0.09F) / 0.13F);
}

Eigen::Vector3f saccade(double t_s, unsigned seed) {
  // Fixations of 0.4 to 1.2 s; the jump itself takes about 40 ms.
  const double pace = t_s / 0.8 + 0.3 * static_cast<double>(noise(t_s / 2.0, seed + 21));
  const double index = std::floor(pace);
  const auto into = static_cast<float>((pace - index) * 0.8);
  const auto at = [&](double i) -> Eigen::Vector3f {
    return Eigen::Vector3f(noise(i, seed + 31), noise(i, seed + 32), noise(i, seed + 33)) * 0.03F;
  };
  return at(index - 1) + (at(index) - at(index - 1)) * minimum_jerk(into / 0.04F);
}

}  // namespace counterpart
