#include "vhd_renderer/motion/grasp_motion.hpp"

#include <cmath>

#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Isometry3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

float reach_time(float distance, const std::string& style) {
  const float usual = std::clamp(0.55F + 0.75F * distance, 0.65F, 1.05F);
  return style == "slam" ? usual * 0.8F : style == "hesitant" ? usual * 1.5F : usual;
}

}  // namespace

const char* phase_name(GraspPhase phase) {
  static constexpr std::array<const char*, 6> names{"reach", "close", "carry", "release", "retract", "done"};
  return names[static_cast<std::size_t>(phase)];
}

float natural_heading(std::size_t side, const Vector3f& target_S) {
  const float s = side == right_side ? 1.F : -1.F;
  const float dx = target_S.x() - s * 0.26F;
  const float dy = std::max(0.1F, target_S.y() + 0.55F);
  return std::clamp(0.85F * std::atan2(-dx, dy), -radians(40), radians(40));
}

Isometry3f touch_frame(const Figure& figure, const HandParts& hand, const HandShape& shape, const Isometry3f& X_WP) {
  Isometry3f X = X_WP;
  X.translation() = fingertip_W(figure, hand, shape, index_finger).tip;
  return X;
}

ArmGoal holding(const Isometry3f& X_WP, const GraspPoint& point, const HandShape& shape) {
  Isometry3f X_SP = Isometry3f::Identity();
  X_SP.linear() = AngleAxisf(point.heading_rad + pi_f / 2, Vector3f::UnitZ()).toRotationMatrix();
  X_SP.translation() = point.foot_S;
  const Isometry3f X_SW = X_SP * X_WP.inverse();
  ArmGoal goal;
  goal.wrist_S = X_SW.translation();
  goal.R_SW = Quaternionf(X_SW.linear()).normalized();
  goal.shape = shape;
  return goal;
}

GraspMotion::GraspMotion(const GraspTask& task, const Grip& grip, const Figure& figure, const HandParts& hand,
                         const ArmGoal& start, const ArmGoal& rest)
    : task_(task), grip_(grip), start_(start), rest_(rest), touch_shape_(hand_shape("point")), X_WP_(grip.X_WP) {
  if (task_.touch_only) {
    X_WP_ = touch_frame(figure, hand, touch_shape_, grip.X_WP);
    task_.from = task_.path.back();
    task_.path.clear();
  }
  const ArmGoal first = goal_for(task_.from, grip_.closed);
  const bool slam = task_.style == "slam";
  const bool hesitant = task_.style == "hesitant";
  end_s_[0] = static_cast<double>(reach_time((first.wrist_S - start_.wrist_S).norm(), task_.style));
  end_s_[1] = end_s_[0] + (task_.style == "point" ? 1.0 : task_.touch_only ? 0.3 : hesitant ? 0.45 : 0.22);
  double t = end_s_[1];
  GraspPoint at = task_.from;
  for (const GraspPoint& to : task_.path) {
    const float distance = (to.foot_S - at.foot_S).head<2>().norm();
    const float seconds = std::clamp(0.5F + 0.95F * distance, 0.5F, 1.05F) * (slam ? 0.85F : hesitant ? 1.4F : 1.F);
    hops_.push_back({at, to, t, t + static_cast<double>(seconds),
                     std::max(task_.clearance_m, 0.028F + 0.10F * distance) * (slam ? 1.5F : 1.F)});
    t += static_cast<double>(seconds);
    at = to;
  }
  end_s_[2] = t;
  end_s_[3] = t + (task_.touch_only ? 0.05 : 0.2);
  const ArmGoal last = goal_for(at, grip_.open);
  end_s_[4] = end_s_[3] + static_cast<double>(reach_time((last.wrist_S - rest_.wrist_S).norm(), "")) * 0.95;
  if (task_.duration_s > 0) {
    const double scale = task_.duration_s / end_s_[4];
    for (double& end : end_s_) end *= scale;
    for (Hop& hop : hops_) {
      hop.start_s *= scale;
      hop.end_s *= scale;
    }
  }
}

ArmGoal GraspMotion::goal_for(const GraspPoint& point, const HandShape& shape) const {
  return holding(X_WP_, point, shape);
}

double GraspMotion::start_of(GraspPhase phase) const {
  const auto i = static_cast<std::size_t>(phase);
  return i == 0 ? 0 : end_s_[i - 1];
}

// From a free hand pose (u = 0) to the open hand round a piece (1): up, along over the heads of the others, and down
// from straight above.
ArmGoal GraspMotion::between(const ArmGoal& free_hand, const GraspPoint& point, const HandShape& open, float u) const {
  ArmGoal g = goal_for(point, open);
  const float there_z = g.wrist_S.z();
  const float hover = task_.clearance_m + 0.012F;
  const float along = minimum_jerk((u - 0.05F) / 0.62F);
  g.wrist_S = free_hand.wrist_S + (g.wrist_S - free_hand.wrist_S) * along;
  g.wrist_S.z() =
      lerp(free_hand.wrist_S.z(), there_z + hover, minimum_jerk(u / 0.45F)) - hover * minimum_jerk((u - 0.52F) / 0.48F);
  g.R_SW = free_hand.R_SW.slerp(along, g.R_SW);
  g.shape = blend(free_hand.shape, open, along);
  g.swivel_rad = lerp(free_hand.swivel_rad, g.swivel_rad, along);
  g.help = lerp(free_hand.help, g.help, along);
  return g;
}

GraspMoment GraspMotion::at(double t_s) const {
  GraspMoment m;
  const HandShape& open = task_.touch_only ? touch_shape_ : grip_.open;
  const HandShape& closed = task_.touch_only ? touch_shape_ : grip_.closed;
  const GraspPoint& goal = hops_.empty() ? task_.from : hops_.back().b;
  const auto share = [](double t, double a, double b) { return static_cast<float>((t - a) / std::max(1e-6, b - a)); };

  const GraspPoint& here = t_s < end_s_[1] ? task_.from : goal;
  m.target_S = m.held_S = here.foot_S;
  m.heading_rad = here.heading_rad;
  if (t_s < end_s_[0]) {
    m.phase = GraspPhase::reach;
    m.goal = between(start_, here, open, share(t_s, 0, end_s_[0]));
  } else if (t_s < end_s_[1]) {
    m.phase = GraspPhase::close;
    m.goal = goal_for(here, blend(open, closed, minimum_jerk(share(t_s, end_s_[0], end_s_[1]))));
  } else if (t_s < end_s_[2]) {
    m.phase = GraspPhase::carry;
    m.holds = true;
    const Hop* hop = &hops_.front();
    for (const Hop& one : hops_) {
      if (t_s >= one.start_s) hop = &one;
    }
    // Up from between the neighbours, along, down between the others.
    const float u = share(t_s, hop->start_s, hop->end_s);
    const float along = minimum_jerk((u - 0.15F) / 0.70F);
    m.held_S = hop->a.foot_S + (hop->b.foot_S - hop->a.foot_S) * along;
    m.held_S.z() += hop->lift_m * minimum_jerk(u / 0.36F) * minimum_jerk((1 - u) / 0.36F);
    m.target_S = hop->b.foot_S;
    m.heading_rad = lerp(hop->a.heading_rad, hop->b.heading_rad, along);
    m.goal = goal_for({m.held_S, m.heading_rad}, closed);
  } else if (t_s < end_s_[3]) {
    m.phase = GraspPhase::release;
    m.goal = goal_for(here, blend(closed, open, minimum_jerk(share(t_s, end_s_[2], end_s_[3]))));
  } else {
    m.phase = t_s < end_s_[4] ? GraspPhase::retract : GraspPhase::done;
    m.goal = between(rest_, here, open, 1 - std::min(1.F, share(t_s, end_s_[3], end_s_[4])));
  }
  return m;
}

}  // namespace counterpart
