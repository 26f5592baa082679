// Where the stage's camera is at a time: a path, the shake of the hand that holds it, and the zoom. R is the room's
// frame: that of the board where it first lay.
#pragma once

#include <cstdint>
#include <optional>

#include "vhd_renderer/draw/view.hpp"

namespace counterpart::stage {

struct CameraPath {
  Eigen::Vector3d eye_R{0.10, 0.82, 0.66};
  Eigen::Vector3d target_R{0.0, -0.20, 0.15};
  double orbit_rad = 0;  // to and fro round the target, each side
  double orbit_period_s = 16;
  std::optional<Eigen::Vector3d> dolly_to_R;  // to and fro between eye_R and here
  double dolly_period_s = 12;
  double sweep_rad_s = 0;  // the view's middle runs round the target in a circle at this speed, reached after a second
  double sweep_radius_rad = 0.2;
  double zoom_low = 1;  // the focal length's factor runs to and fro between both, from 1
  double zoom_high = 1;
  double zoom_period_s = 10;
  double shake_m = 0;  // of a hand-held camera, standard deviation
  double shake_rad = 0;
  std::uint64_t seed = 1;
};

// Exact and smooth in time; the same for the same seed.
Eigen::Isometry3d camera_at_X_CR(const CameraPath& path, double t_s);
double zoom_at(const CameraPath& path, double t_s);

}  // namespace counterpart::stage
