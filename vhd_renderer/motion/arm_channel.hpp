// One arm's goal over time: whoever drives it may change at any moment, the hand never jumps. Goals may be written in any
// one frame instead of S; the difference between two of them then fades in that frame.
#pragma once

#include "vhd_renderer/motion/body_controls.hpp"

namespace counterpart {

class ArmChannel {
 public:
  // `source` tells who made the goal; when it changes, what is left between old and new goal fades.
  ArmGoal step(std::uint64_t source, const ArmGoal& goal, double now_s);

  // What the arm shows now.
  const ArmGoal& shown() const { return shown_; }

 private:
  bool fresh_ = true;
  std::uint64_t source_ = 0;
  ArmGoal shown_;
  Eigen::Vector3f offset_{0, 0, 0};
  Eigen::Vector3f turn_{0, 0, 0};  // rotation vector in S
  float swivel_ = 0;
  float help_ = 0;
  HandShape from_shape_;
  double since_s_ = 0;
  float fade_s_ = 0.4F;
};

}  // namespace counterpart
