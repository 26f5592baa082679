#include "vhd_renderer/motion/arm_plan.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "vhd_renderer/motion/curves.hpp"
#include "vhd_renderer/motion/limb.hpp"
#include "vhd_renderer/motion/shoulder.hpp"
#include "vhd_renderer/motion/swivel.hpp"

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float fastest_lift_rad_s = 4.4F;
constexpr float hurried_lift_rad_s = 12;  // where a shoulder would be strained otherwise
// Of a bone against the trunk; the joints add a little to it, up to joint_limit::fastest_turn_rad_s.
constexpr float fastest_bone_rad_s = 15;
constexpr int glances = 7;                // to either side of the wanted lift ...
constexpr int glances_all_round = 24;     // ... and where the elbow may be anywhere
constexpr float margin_rad = radians(2);  // kept from the end of a shoulder's range

// 1 for a hand on the table he sits at, 0 for one that is well over it or not at the table.
float on_table(const Vector3f& wrist_S, const BodyControls& c) {
  const float low = 1 - minimum_jerk((wrist_S.z() - c.table_z_m - 0.06F) / 0.10F);
  return low * unit_clamp((wrist_S.y() - c.table_edge_y_m) / 0.03F);
}

// One arm in one frame.
struct Arm {
  const Limb& limb;
  const BodyControls& c;
  const ArmGoal& goal;
  Vector3f shoulder_S;
  Vector3f trunk_S;
  Quaternionf trunk;
  Quaternionf heading;
  float side;
  float lies;  // on the table, 0..1: the hand, as it is meant to
  const ArmMemory* before;

  Swivel swivel(const Vector3f& wrist_S) const { return Swivel::of_arm(heading, shoulder_S, wrist_S, side); }
};

// No hand comes nearer to its own shoulder than an arm can be folded. One in the air goes round it in front; one that
// lies on the table, when its owner bends over it, slides outwards.
Vector3f off_shoulder(const Arm& arm, const Vector3f& wrist_S) {
  constexpr float nearest_m = 0.20F;
  const Vector3f away = wrist_S - arm.shoulder_S;
  const float missing = nearest_m - away.norm();
  if (missing <= 0) return wrist_S;
  const Vector3f in_front = arm.heading * Vector3f(0.5F * arm.side, 1, -0.5F).normalized() * missing;
  const Vector3f round_S = arm.shoulder_S + (away + in_front).normalized() * nearest_m;
  const Vector3f flat(away.x(), away.y(), 0);
  const float nearest_flat_m = std::sqrt(nearest_m * nearest_m - away.z() * away.z());
  const Vector3f aside = arm.heading * Vector3f(arm.side, 0, 0) * (nearest_flat_m - flat.norm());
  const Vector3f slid_S = arm.shoulder_S + Vector3f(0, 0, away.z()) + (flat + aside).normalized() * nearest_flat_m;
  return round_S + (slid_S - round_S) * arm.lies;
}

// The lift nearest to the wanted one that keeps elbow and forearm out of the table, upwards first.
float clear_of_table(const Arm& arm, const Vector3f& wrist_S, const Swivel& swivel, float wanted) {
  const BodyControls& c = arm.c;
  // A hand below the table top is under the table, and so may its arm be.
  const float above = unit_clamp((wrist_S.z() - c.table_z_m + 0.01F) / 0.03F);
  const auto clearance = [&](float lift) {
    const Vector3f elbow = bend_of(arm.limb, arm.shoulder_S, wrist_S, swivel.turned(lift)).middle_S;
    float least = 1;
    for (const float share : {0.F, 0.25F, 0.5F, 0.75F}) {  // of the forearm, which is thinner towards the wrist
      const Vector3f p = elbow + (wrist_S - elbow) * share;
      // The table begins softly, so that the elbow does not jump at its edge.
      const float over = above * unit_clamp((p.y() - c.table_edge_y_m + 0.07F) / 0.07F);
      least = std::min(least, p.z() - (c.table_z_m + lerp(0.06F, 0.035F, share)) + (1 - over) * 0.5F);
    }
    return least;
  };
  float best = wanted;
  float most = clearance(wanted);
  constexpr float stride = radians(10);
  constexpr float farthest = radians(120);
  for (int k = 1; k * stride <= farthest && most < 0; ++k) {
    for (const float sign : {1.F, -1.F}) {
      const float lift = wanted + sign * stride * static_cast<float>(k);
      const float here = clearance(lift);
      if (here <= most) continue;
      most = here;
      best = lift;
    }
  }
  if (best == wanted || most < 0) return best;
  float low = best + (best < wanted ? stride : -stride);
  for (int round = 0; round < 8; ++round) {
    const float middle = 0.5F * (low + best);
    (clearance(middle) < 0 ? low : best) = middle;
  }
  return best;
}

ArmMemory memory_of(const Arm& arm, const Vector3f& wrist_S, const LimbBend& bend) {
  const Quaternionf to_T = arm.trunk.conjugate();
  ArmMemory memory;
  memory.wrist_T = to_T * (wrist_S - arm.trunk_S);
  memory.upper_T = to_T * align(arm.limb.upper_H, arm.limb.hinge_H, bend.upper_S, bend.hinge_S);
  memory.fore_T = to_T * align(arm.limb.lower_H, arm.limb.hinge_H, bend.lower_S, bend.hinge_S);
  return memory;
}

ArmPlan try_lift(const Arm& arm, const Vector3f& wrist_S, const Swivel& swivel, float lift) {
  ArmPlan plan;
  plan.wrist_S = wrist_S;
  plan.pole_S = swivel.turned(lift);
  const LimbBend bend = bend_of(arm.limb, arm.shoulder_S, wrist_S, plan.pole_S);
  const Quaternionf to_T = arm.trunk.conjugate();
  plan.strain_rad = shoulder_angles(to_T * bend.upper_S, to_T * bend.hinge_S, arm.side).excess_rad(margin_rad);
  plan.memory = memory_of(arm, wrist_S, bend);
  if (arm.before != nullptr && arm.c.dt_s > 0) {
    const auto elbow = [](const ArmMemory& memory) { return Quaternionf(memory.upper_T.conjugate() * memory.fore_T); };
    const float turn = std::max({arm.before->upper_T.angularDistance(plan.memory.upper_T),
                                 arm.before->fore_T.angularDistance(plan.memory.fore_T),
                                 elbow(*arm.before).angularDistance(elbow(plan.memory))});
    plan.strain_rad += std::max(0.F, turn - fastest_bone_rad_s * arm.c.dt_s);
  }
  return plan;
}

// The wrist there, if that is not in his shoulder, the elbow as near to where the goal and the table have it as can be.
ArmPlan try_wrist(const Arm& arm, const Vector3f& wanted_S, float fastest_rad_s = fastest_lift_rad_s) {
  const Vector3f wrist_S = off_shoulder(arm, wanted_S);
  const Swivel swivel = arm.swivel(wrist_S);
  float wanted = clear_of_table(arm, wrist_S, swivel, arm.goal.swivel_rad);
  float low = wanted - pi_f;
  float high = wanted + pi_f;
  int count = glances_all_round;
  if (arm.before != nullptr && arm.c.dt_s > 0) {
    const Vector3f hinge_before = arm.trunk * (arm.before->fore_T * arm.limb.hinge_H);
    const float before = swivel.angle_of(swivel.line.cross(hinge_before));
    low = before - fastest_rad_s * arm.c.dt_s;
    high = before + fastest_rad_s * arm.c.dt_s;
    wanted = std::clamp(wanted, low, high);
    count = glances;
  }
  ArmPlan best = try_lift(arm, wrist_S, swivel, wanted);
  for (int k = 1; k <= count && best.strain_rad > 0; ++k) {
    const float share = static_cast<float>(k) / static_cast<float>(count);
    for (const float lift : {lerp(wanted, low, share), lerp(wanted, high, share)}) {
      ArmPlan other = try_lift(arm, wrist_S, swivel, lift);
      if (other.strain_rad < best.strain_rad) best = std::move(other);
    }
  }
  return best;
}

}  // namespace

ArmPlan plan_arm(const Anatomy& a, const BodyControls& c, const ArmGoal& goal, const BodyPose& pose, std::size_t s,
                 const ArmMemory* before) {
  const int chest = a.trunk.back();
  const Arm arm{a.arms[s].limb,
                c,
                goal,
                pose.p_S[at(a.arms[s].limb.root)],
                pose.p_S[at(chest)],
                pose.G[at(chest)],
                Quaternionf(AngleAxisf(c.heading_rad, Vector3f::UnitZ())),
                s == right_side ? 1.F : -1.F,
                on_table(c.arms[s].wrist_S, c),
                before};
  ArmPlan best = try_wrist(arm, arm.goal.wrist_S);
  const auto try_places = [&](const Vector3f& from, const Vector3f& to, std::initializer_list<float> shares,
                              float fastest_rad_s) {
    for (const float share : shares) {
      if (best.strain_rad <= 0) return;
      ArmPlan part = try_wrist(arm, from + (to - from) * share, fastest_rad_s);
      if (part.strain_rad < best.strain_rad) best = std::move(part);
    }
  };
  // Then a part of the way there from where the wrist was.
  const bool was_somewhere = before != nullptr && c.dt_s > 0;
  const Vector3f was_S = was_somewhere ? Vector3f(arm.trunk_S + arm.trunk * before->wrist_T) : arm.goal.wrist_S;
  if (was_somewhere) {
    for (const float fastest_rad_s : {fastest_lift_rad_s, hurried_lift_rad_s}) {
      try_places(was_S, arm.goal.wrist_S, {0.8F, 0.6F, 0.4F, 0.25F, 0.1F, 0.F}, fastest_rad_s);
    }
  }
  // Then back to where any arm is at its ease.
  const Vector3f at_ease_S =
      arm.shoulder_S + arm.trunk * Vector3f(0.15F * arm.side, 0.6F, -0.35F) * arm.limb.length_m();
  try_places(was_S, at_ease_S, {0.1F, 0.2F, 0.4F, 0.6F, 0.8F, 1.F}, hurried_lift_rad_s);
  return best;
}

}  // namespace counterpart
