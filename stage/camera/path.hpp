// Where the stage's camera is at a time: a path and the shake of the hand that holds it.
#pragma once

#include <cstdint>

#include "vhd_renderer/draw/view.hpp"

namespace counterpart::stage {

struct CameraPath {
  Eigen::Vector3d eye_B{0.10, 0.82, 0.66};
  Eigen::Vector3d target_B{0.0, -0.20, 0.15};
  double orbit_rad = 0;       // to and fro round the target, each side
  double orbit_period_s = 16;
  double shake_m = 0;         // of a hand-held camera, standard deviation
  double shake_rad = 0;
  std::uint64_t seed = 1;
};

// Exact and smooth in time; the same for the same seed.
Eigen::Isometry3d camera_at(const CameraPath& path, double t_s);

}  // namespace counterpart::stage
