// Walking as planned footsteps: a path for the pelvis, and feet that stand still until they are lifted.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "vhd_renderer/motion/body_controls.hpp"

namespace counterpart {

struct Place {
  Eigen::Vector2f p_S{0, 0};
  float heading_rad = 0;  // about z from S's y axis
};

struct WalkStyle {
  float speed_m_s = 1.15F;
  float step_m = 0.52F;         // on the pelvis' path from one footfall to the next
  float half_width_m = 0.085F;  // of the stance
  float lift_m = 0.06F;
};

class Walk {
 public:
  Walk() = default;

  // From standing at `start` (feet side by side) through the points to standing at `end`.
  Walk(const Place& start, const std::vector<Eigen::Vector2f>& through, const Place& end, const WalkStyle& style,
       const Anatomy& anatomy);

  double duration_s() const { return duration_s_; }

  // Pelvis, feet and trunk at a time since the start, 0 .. duration_s(), on a floor at z = 0. Returns the swing of the
  // arms, -1..1, positive when the right one is in front.
  float pose(double t_s, BodyControls& controls) const;

 private:
  struct Footfall {
    float at = 0;  // on the path; the foot stands there from `land` to `lift`
    float land = 0;
    float lift = 0;
    Place place;
  };

  Place along(float s) const;
  float path_at(double t_s) const;
  FootGoal foot(std::size_t side, float s) const;

  std::vector<Place> path_;      // samples
  std::vector<float> distance_;  // of the samples; a turn on the spot counts as distance too
  std::array<std::vector<Footfall>, 2> feet_;
  WalkStyle style_;
  float length_ = 0;
  float ramp_s_ = 0.4F;
  float leg_m_ = 0.8F;
  float hip_height_m_ = 0.86F;
  float ball_forward_m_ = 0.12F;
  double duration_s_ = 0;
};

// Feet of somebody who stands at a place.
FootGoal standing_foot(const Place& place, std::size_t side, const Anatomy& anatomy, float half_width_m);

// Height of the hip joints when he stands, a little less than straight.
float standing_hip_height(const Anatomy& anatomy);

// -pi..pi
float wrap_angle(float angle);

}  // namespace counterpart
