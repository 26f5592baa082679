#include "stage/camera/path.hpp"

#include <cmath>

namespace counterpart::stage {
namespace {

constexpr double kTwoPi = 6.283185307179586;

// A number in [0, 1) from two whole ones (SplitMix64).
double hashed(std::uint64_t seed, std::uint64_t n) {
  std::uint64_t z = seed * 0x9E3779B97F4A7C15u + n * 0xD1B54A32D192ED03u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

// Smooth wandering with variance 1: a few waves of the frequencies in which hands tremble and sway.
double wander(double t_s, std::uint64_t seed, std::uint64_t channel) {
  constexpr double kFrequencies_hz[] = {0.23, 0.61, 1.3, 2.7, 5.9};
  constexpr double kWeights[] = {1.0, 0.7, 0.4, 0.18, 0.06};
  double sum = 0, power = 0;
  for (std::uint64_t i = 0; i < 5; ++i) {
    const double phase = kTwoPi * hashed(seed, channel * 16 + i);
    const double frequency = kFrequencies_hz[i] * (0.8 + 0.4 * hashed(seed, channel * 16 + 8 + i));
    sum += kWeights[i] * std::sin(kTwoPi * frequency * t_s + phase);
    power += kWeights[i] * kWeights[i] / 2;
  }
  return sum / std::sqrt(power);
}

}  // namespace

Eigen::Isometry3d camera_at_X_CR(const CameraPath& path, double t_s) {
  const double angle = path.orbit_rad * std::sin(kTwoPi * t_s / path.orbit_period_s);
  Eigen::Vector3d start = path.eye_R;
  if (path.dolly_to_R) {
    start += (0.5 - 0.5 * std::cos(kTwoPi * t_s / path.dolly_period_s)) * (*path.dolly_to_R - path.eye_R);
  }
  const Eigen::Vector3d arm = start - path.target_R;
  Eigen::Vector3d eye = path.target_R + Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * arm;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const auto channel = static_cast<std::uint64_t>(axis);
    eye[axis] += path.shake_m * wander(t_s, path.seed, channel);
    turn[axis] = path.shake_rad * wander(t_s, path.seed, 3 + channel);
  }
  if (path.sweep_rad_s > 0) {
    const double way = path.sweep_rad_s * (t_s < 0 ? 0 : t_s < 1 ? t_s * t_s / 2 : t_s - 0.5);
    turn += path.sweep_radius_rad *
            Eigen::Vector3d(std::cos(way / path.sweep_radius_rad), std::sin(way / path.sweep_radius_rad), 0);
  }
  Eigen::Isometry3d X_CR = look_at_X_CB(eye, path.target_R);
  if (turn.norm() > 0) X_CR = Eigen::Isometry3d(Eigen::AngleAxisd(turn.norm(), turn.normalized())) * X_CR;
  return X_CR;
}

double zoom_at(const CameraPath& path, double t_s) {
  const double range = std::log(path.zoom_high / path.zoom_low);
  if (range <= 0) return 1;
  const double start = std::acos(1 + 2 * std::log(path.zoom_low) / range);  // where the factor is 1
  return path.zoom_low * std::exp(range * (0.5 - 0.5 * std::cos(start + kTwoPi * t_s / path.zoom_period_s)));
}

}  // namespace counterpart::stage
