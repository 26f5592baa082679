// A hand that cannot be held as its goal has it would dip into what it lies on: how far it has to come up.
#pragma once

#include <array>

#include "vhd_renderer/motion/body_controls.hpp"

namespace counterpart {

// Points of a shaped hand that touch a table first: tip and pad of each finger, in the hand frame W.
using FingerEnds = std::array<Eigen::Vector3f, 10>;
FingerEnds finger_ends_W(const Figure& figure, const HandParts& hand, const HandShape& shape);

// Metres by which the wrist has to rise until no finger is deeper in table or board than its goal has it, and none
// inside; 0 if the hand is where its goal says.
float lift_out_of_table(const BodyControls& controls, const ArmGoal& goal, const FingerEnds& ends_W,
                        const Eigen::Vector3f& wrist_S, const Eigen::Quaternionf& R_SW);

}  // namespace counterpart
