// A pose in the terms of anatomy, and how far a person's joints go. It judges poses of any figure with the joints that
// motion needs, whoever made them.
#pragma once

#include <string>
#include <vector>

#include "vhd_renderer/motion/anatomy.hpp"
#include "vhd_renderer/motion/body_controls.hpp"
#include "vhd_renderer/motion/pose.hpp"

namespace counterpart {

struct JointAngle {
  std::string name;  // "r_wrist flexion"
  float angle_rad = 0;
  AngleRange range;

  // How far beyond its range, radians; 0 inside.
  float excess_rad() const;
};

// Every angle that has a range. The pose's G and p_S have to be up to date.
std::vector<JointAngle> joint_angles(const Figure& figure, const Anatomy& anatomy, const BodyPose& pose);

// The turn (see rotation_of) that a rotation is.
Turn turn_of(const Eigen::Quaternionf& rotation);

}  // namespace counterpart
