// A pose in the terms of anatomy, and how far a person's joints go. It judges poses of any figure with the joints that
// motion needs, whoever made them.
#pragma once

#include <string>
#include <vector>

#include "vhd_renderer/motion/anatomy.hpp"
#include "vhd_renderer/motion/body_controls.hpp"
#include "vhd_renderer/motion/pose.hpp"

namespace counterpart {

struct AngleRange {
  float least_rad = 0;
  float most_rad = 0;
};

// Active ranges of healthy adults, rounded outwards (Kapandji, The Physiology of the Joints).
namespace joint_limit {
inline constexpr float degree = 3.14159265F / 180;
inline constexpr AngleRange wrist_flexion{-80 * degree, 85 * degree};    // positive: towards the palm
inline constexpr AngleRange wrist_deviation{-45 * degree, 30 * degree};  // positive: towards the thumb
inline constexpr AngleRange pronation{-100 * degree, 100 * degree};      // 0: thumb where the elbow closes to
}  // namespace joint_limit

struct JointAngle {
  std::string name;  // "r_wrist flexion"
  float angle_rad = 0;
  AngleRange range;

  // How far beyond its range, radians; 0 inside.
  float excess_rad() const;
};

// Every angle that has a range. The pose's G and p_S have to be up to date.
std::vector<JointAngle> joint_angles(const Figure& figure, const Anatomy& anatomy, const BodyPose& pose);

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

// The turn (see rotation_of) that a rotation is.
Turn turn_of(const Eigen::Quaternionf& rotation);

}  // namespace counterpart
