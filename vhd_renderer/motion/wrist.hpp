// How far wrists and forearms go, and a hand held against its forearm in those terms.
#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace counterpart {

struct AngleRange {
  float least_rad = 0;
  float most_rad = 0;

  float nearest(float angle_rad) const { return std::clamp(angle_rad, least_rad, most_rad); }
  // How far beyond it an angle is; 0 inside.
  float excess(float angle_rad) const { return std::max({0.F, least_rad - angle_rad, angle_rad - most_rad}); }
};

// Active ranges of healthy adults, rounded outwards (Kapandji, The Physiology of the Joints).
namespace joint_limit {
inline constexpr float degree = 3.14159265F / 180;
inline constexpr AngleRange wrist_flexion{-80 * degree, 85 * degree};    // positive: towards the palm
inline constexpr AngleRange wrist_deviation{-45 * degree, 30 * degree};  // positive: towards the thumb
inline constexpr AngleRange pronation{-100 * degree, 100 * degree};      // 0: thumb where the elbow closes to
// A joint turns against its parent, and moves in the room, no faster than this in anything a director may ask for: the
// largest jump from frame to frame, by frame time. People throw faster, but do not play draughts so.
inline constexpr float fastest_turn_rad_s = 20;  // an elbow, called back and forth
inline constexpr float fastest_move_m_s = 7;     // a foot swung forward in a hurry
}  // namespace joint_limit

// A hand against its forearm: how it is turned about the forearm, and how it is bent at the wrist.
struct WristAngles {
  float pronation_rad = 0;
  float flexion_rad = 0;
  float deviation_rad = 0;
};

// `hinge` and `lower`: unit, the elbow's axis and the forearm's direction; R_W: the hand frame; all in the same frame.
WristAngles wrist_angles(const Eigen::Vector3f& hinge, const Eigen::Vector3f& lower, const Eigen::Matrix3f& R_W,
                         float thumb_side);

// The hand frame that has these angles.
Eigen::Matrix3f hand_frame(const Eigen::Vector3f& hinge, const Eigen::Vector3f& lower, const WristAngles& angles,
                           float thumb_side);

// The nearest angles that a wrist has, reached from `before` no faster than a wrist turns; `dt_s` 0: at once.
WristAngles held_back(const WristAngles& wanted, const WristAngles& before, float dt_s);

}  // namespace counterpart
