#include "vhd_renderer/motion/arm_channel.hpp"

#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {

ArmGoal ArmChannel::step(std::uint64_t source, const ArmGoal& goal, double now_s) {
  if (fresh_) {
    fresh_ = false;
    source_ = source;
    from_shape_ = goal.shape;
    since_s_ = now_s - 10;
    shown_ = goal;
    return shown_;
  }
  if (source != source_) {
    source_ = source;
    offset_ = shown_.wrist_S - goal.wrist_S;
    Eigen::AngleAxisf turn(shown_.R_SW * goal.R_SW.conjugate());
    float angle = turn.angle();
    if (angle > pi_f) angle -= 2 * pi_f;
    turn_ = turn.axis() * angle;
    swivel_ = shown_.swivel_rad - goal.swivel_rad;
    help_ = shown_.help - goal.help;
    from_shape_ = shown_.shape;
    since_s_ = now_s;
    fade_s_ = std::clamp(0.3F + 0.8F * offset_.norm() + 0.12F * turn_.norm(), 0.3F, 1.0F);
  }
  const float left = 1 - minimum_jerk(static_cast<float>(now_s - since_s_) / fade_s_);
  shown_ = goal;
  if (left > 0) {
    shown_.wrist_S += offset_ * left;
    const Eigen::Vector3f turn = turn_ * left;
    const float angle = turn.norm();
    if (angle > 1e-6F) shown_.R_SW = (Eigen::AngleAxisf(angle, turn / angle) * goal.R_SW).normalized();
    shown_.swivel_rad += swivel_ * left;
    shown_.help += help_ * left;
    shown_.shape = blend(goal.shape, from_shape_, left);
  }
  return shown_;
}

}  // namespace counterpart
