#include <cmath>

#include "vhd_renderer/motion/arm_plan.hpp"
#include "vhd_renderer/motion/body_controls.hpp"
#include "vhd_renderer/motion/curves.hpp"
#include "vhd_renderer/motion/hand_lift.hpp"
#include "vhd_renderer/motion/limb.hpp"
#include "vhd_renderer/motion/pose.hpp"

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

// The largest lean with which a seated person reaches: a share of each goes with `lean` from 0 to 1.
constexpr float lean_pelvis = radians(24);
constexpr float lean_spine = radians(38);
constexpr float lean_twist = radians(20);
constexpr float lean_clavicle = radians(16);

// And bends over and turns farther once he is off his chair.
constexpr float rise_pelvis = radians(24);
constexpr float rise_twist = radians(12);

struct Lean {
  std::array<float, 2> pull{0, 0};  // of each arm; 0..1 together
  float rise = 0;                   // off the chair, 0..1

  float amount() const { return pull[left_side] + pull[right_side]; }
};

// Root, spine and shoulder girdle.
void set_trunk(const Figure& figure, const Anatomy& a, const BodyControls& c, const Lean& lean, BodyPose& pose) {
  Turn pelvis = c.pelvis;
  pelvis.pitch += lean.amount() * lean_pelvis + lean.rise * rise_pelvis;
  const Quaternionf G = rotation_of(c.heading_rad, pelvis);
  const Vector3f hips_H = 0.5F * (figure.joints[at(a.legs[0].limb.root)].X_HJ.translation() +
                                  figure.joints[at(a.legs[1].limb.root)].X_HJ.translation());
  pose.turn[at(a.root)] = G;
  pose.root_p_S = c.pelvis_S + c.rise_S * lean.rise + G * (figure.joints[at(a.root)].X_HJ.translation() - hips_H);
  Turn spine = c.spine;
  spine.pitch += lean.amount() * lean_spine;
  spine.yaw += (lean_twist + rise_twist * lean.rise) * (lean.pull[right_side] - lean.pull[left_side]);
  const Quaternionf each = rotation_of(0, spine * (1.F / static_cast<float>(a.spine.size())));
  for (const int j : a.spine) pose.turn[at(j)] = each;
  update_chain(figure, pose, a.trunk);
  for (const std::size_t s : {left_side, right_side}) {
    const int clavicle = a.arms[s].clavicle;
    if (clavicle < 0) continue;
    const float side = s == right_side ? 1.F : -1.F;
    const float forward = lean_clavicle * lean.pull[s];
    pose.turn[at(clavicle)] =
        AngleAxisf(side * forward, Vector3f::UnitZ()) * AngleAxisf(-side * radians(24) * c.shrug[s], Vector3f::UnitY());
    update_chain(figure, pose, a.arms[s].girdle);
  }
}

float reach_of(const Anatomy& a, const BodyControls& c, const BodyPose& pose, std::size_t s) {
  return (pose.p_S[at(a.arms[s].limb.root)] - c.arms[s].wrist_S).norm();
}

// How far he has to lean so that no arm is stretched: the arm gives way first, the trunk comes early and softly. Where
// leaning does not bring a hand to its goal, as far as it brings it nearer.
Lean find_lean(const Figure& figure, const Anatomy& a, const BodyControls& c, BodyPose& pose) {
  set_trunk(figure, a, c, {}, pose);
  std::array<float, 2> wanted{};
  std::array<float, 2> share{};
  float excess_sum = 0;
  for (const std::size_t s : {left_side, right_side}) {
    const float length = a.arms[s].limb.length_m();
    const float distance = reach_of(a, c, pose, s);
    const float soft = soft_limit(distance, 0.72F * length, 0.93F * length);
    wanted[s] = distance - (distance - soft) * c.arms[s].help;
    share[s] = std::max(0.F, distance - wanted[s]);
    excess_sum += share[s];
  }
  if (excess_sum < 1e-5F) return {};
  // He leans, then comes off his chair where he can, then leans the rest: nobody lies down on the table before he gets
  // up.
  constexpr float early = 0.7F;
  const bool can_rise = c.rise_S.z() > 0;
  const auto lean_of = [&](float amount) {
    const float rise = can_rise ? unit_clamp(amount - early) : 0;
    const float pull = std::min(amount - rise, 1.F) / excess_sum;
    return Lean{{pull * share[left_side], pull * share[right_side]}, rise};
  };
  const auto missing = [&](float amount) {
    set_trunk(figure, a, c, lean_of(amount), pose);
    float worst = -1;
    for (const std::size_t s : {left_side, right_side}) worst = std::max(worst, reach_of(a, c, pose, s) - wanted[s]);
    return worst;
  };
  constexpr int parts = 6;  // of leaning as of rising
  const int most = can_rise ? 2 * parts : parts;
  float best = 0;
  float least = missing(0);
  for (int k = 1; k <= most && least > 0; ++k) {
    const float amount = static_cast<float>(k) / parts;
    const float here = missing(amount);
    if (here >= least) break;
    best = amount;
    least = here;
  }
  if (least > 0) return lean_of(best);
  float low = std::max(0.F, best - 1.F / parts);
  for (int round = 0; round < 8; ++round) {
    const float middle = 0.5F * (low + best);
    (missing(middle) > 0 ? low : best) = middle;
  }
  return lean_of(best);
}

// A trunk does not jump.
Lean held_back(const Lean& wanted, const BodyMemory& before, float dt_s) {
  constexpr float fastest_a_second = 4;
  const auto held = [&](float to, float from) {
    return std::clamp(to, from - fastest_a_second * dt_s, from + fastest_a_second * dt_s);
  };
  Lean lean = wanted;
  for (const std::size_t s : {left_side, right_side}) lean.pull[s] = held(lean.pull[s], before.lean[s]);
  lean.rise = held(lean.rise, before.rise);
  return lean;
}

constexpr float roll_rise_m = 0.0024F;     // of the toes' joint ...
constexpr float roll_rad = radians(2.5F);  // ... while the heel comes up so far

void set_legs(const Figure& figure, const Anatomy& a, const BodyControls& c, SolvedBody& solved) {
  BodyPose& pose = solved.pose;
  for (const std::size_t s : {left_side, right_side}) {
    const LegParts& leg = a.legs[s];
    const FootGoal& foot = c.feet[s];
    const Quaternionf G(AngleAxisf(foot.heading_rad, Vector3f::UnitZ()) *
                        AngleAxisf(-foot.pitch_rad, Vector3f::UnitX()));
    const Vector3f ankle_H = figure.joints[at(leg.limb.end)].X_HJ.translation();
    LimbGoal goal;
    // The foot rolls over its toes' joint. What of its sole lies under that would slide: so the joint comes up a little
    // first, and the weight goes on to the tips of the toes.
    const Vector3f joint_H =
        leg.toe >= 0 ? Vector3f(figure.joints[at(leg.toe)].X_HJ.translation()) : Vector3f(leg.ball_H);
    const bool rolls = leg.toe >= 0 && leg.toe_length_m > 0.02F;
    const float heel_up = std::max(0.F, foot.pitch_rad);
    const float up = rolls ? roll_rise_m * minimum_jerk(heel_up / roll_rad) : 0;
    goal.end_S = foot.ball_S + Vector3f(0, 0, joint_H.z() - leg.ball_H.z() + up) + G * (ankle_H - joint_H);
    goal.end_G = G;
    const float side = s == right_side ? 1.F : -1.F;
    const float knee_heading = 0.5F * (foot.heading_rad + c.heading_rad);
    goal.pole_S = AngleAxisf(knee_heading, Vector3f::UnitZ()) * Vector3f(side * 0.10F, 1, 0.25F);
    if (const int girdle = figure.joints[at(leg.limb.root)].parent; girdle >= 0 && girdle != a.root) {
      pose.turn[at(girdle)].setIdentity();
      update_chain(figure, pose, {girdle});
    }
    solved.foot_gap_m[s] = solve_limb(figure, leg.limb, goal, pose);
    // Toes stay on the floor while the heel comes up.
    const float on_tips = rolls ? std::asin(up / leg.toe_length_m) : 0;
    for (const int toe : leg.toes) pose.turn[at(toe)] = AngleAxisf(heel_up - on_tips, Vector3f::UnitX());
  }
}

Turn direction_turn(const Vector3f& d) {
  return {-std::atan2(d.z(), std::hypot(d.x(), d.y())), 0, std::atan2(-d.x(), d.y())};
}

// 1 for what is before him or beside him; 0 right behind him, where nobody knows which way to turn his head.
float before_him(float yaw) {
  constexpr float beside = 1.9F;
  return 1 - minimum_jerk((std::abs(yaw) - beside) / (pi_f - beside));
}

void set_head(const Figure& figure, const Anatomy& a, const BodyControls& c, const Lean& lean, BodyPose& pose) {
  const Quaternionf trunk = pose.G[at(a.spine.back())];
  const Vector3f neck = pose.p_S[at(a.spine.back())];
  const Vector3f head_H =
      figure.joints[at(a.neck.back())].X_HJ.translation() - figure.joints[at(a.spine.back())].X_HJ.translation();
  const Vector3f eyes = neck + trunk * (head_H + Vector3f(0, 0.08F, 0.08F));
  Turn look = direction_turn(trunk.conjugate() * (c.head_gaze_S - eyes));
  look.yaw = soft_limit(std::abs(look.yaw), 0.6F, 1.2F) * (look.yaw < 0 ? -1.F : 1.F) * before_him(look.yaw);
  look.pitch = std::clamp(look.pitch, -radians(42), radians(42));
  Turn turn = look * c.head_share + c.head;
  // Bent over the table he keeps his face out of it.
  turn.pitch -= radians(12) * lean.amount() + radians(20) * lean.rise;
  turn.pitch = std::max(turn.pitch, -radians(52));
  const Quaternionf each = rotation_of(0, turn * (1.F / static_cast<float>(a.neck.size())));
  for (const int j : a.neck) pose.turn[at(j)] = each;
  update_chain(figure, pose, a.neck);
  const Quaternionf head = pose.G[at(a.neck.back())];
  if (a.jaw >= 0) pose.turn[at(a.jaw)] = AngleAxisf(-c.jaw_rad, Vector3f::UnitX());
  for (const int eye : a.eyes) {
    if (eye < 0) continue;
    // Eyes may hang below other joints of the face; those do not turn.
    const Vector3f eye_S = pose.p_S[at(a.neck.back())] + head * (figure.joints[at(eye)].X_HJ.translation() -
                                                                 figure.joints[at(a.neck.back())].X_HJ.translation());
    Turn aim = direction_turn(head.conjugate() * (c.gaze_S - eye_S));
    aim.yaw = std::clamp(aim.yaw, -radians(34), radians(34)) * before_him(aim.yaw);
    aim.pitch = std::clamp(aim.pitch, -radians(24), radians(30));
    pose.turn[at(eye)] = rotation_of(0, aim);
  }
}

// One arm, its hand as its goal says as far as the wrist lets it. Returns how the hand is turned.
Quaternionf set_arm(const Figure& figure, const Anatomy& a, const BodyControls& c, const ArmGoal& goal, std::size_t s,
                    const ArmMemory* before, SolvedBody& solved, ArmMemory& memory) {
  constexpr float fastest_twist_rad_s = 4;
  const HandParts& hand = a.arms[s].hand;
  const Limb& arm = a.arms[s].limb;
  const ArmPlan plan = plan_arm(a, c, goal, solved.pose, s, before);
  LimbGoal limb;
  limb.end_S = plan.wrist_S;
  limb.end_G = (goal.R_SW * Quaternionf(hand.R_HW).conjugate()).normalized();
  limb.pole_S = plan.pole_S;
  if (before != nullptr && c.dt_s > 0) {
    limb.root_twist = {before->twist_rad - fastest_twist_rad_s * c.dt_s,
                       before->twist_rad + fastest_twist_rad_s * c.dt_s};
  }
  const float limb_gap_m = solve_limb(figure, arm, limb, solved.pose);

  // A hand goes only where its wrist lets it; then the forearm is solved again under it.
  const BodyPose& pose = solved.pose;
  const Vector3f hinge = pose.G[at(arm.middle)] * arm.hinge_H;
  const Vector3f lower = (pose.p_S[at(arm.end)] - pose.p_S[at(arm.middle)]).normalized();
  const WristAngles wanted = wrist_angles(hinge, lower, goal.R_SW.toRotationMatrix(), hand.thumb_side);
  memory = plan.memory;
  memory.bend = before != nullptr ? held_back(wanted, before->bend, c.dt_s) : held_back(wanted, wanted, 0);
  const Quaternionf R_SW(hand_frame(hinge, lower, memory.bend, hand.thumb_side));
  limb.end_G = (R_SW * Quaternionf(hand.R_HW).conjugate()).normalized();
  solve_limb(figure, arm, limb, solved.pose);
  memory.twist_rad = root_twist_of(figure, arm, solved.pose);
  constexpr float palm_m = 0.12F;  // from the wrist to what the hand holds
  // A strained shoulder does not get there either: by about an arm's length for each radian.
  solved.arm_gap_m[s] = limb_gap_m + (plan.wrist_S - c.arms[s].wrist_S).norm() + arm.length_m() * plan.strain_rad +
                        palm_m * R_SW.angularDistance(goal.R_SW);
  return R_SW;
}

ArmMemory set_arm(const Figure& figure, const Anatomy& a, const BodyControls& c, std::size_t s, SolvedBody& solved) {
  const HandParts& hand = a.arms[s].hand;
  const ArmMemory* before = solved.before ? &solved.before->arms[s] : nullptr;
  const FingerEnds ends_W = finger_ends_W(figure, hand, c.arms[s].shape);
  const Vector3f& wrist_S = solved.pose.p_S[at(hand.wrist)];
  ArmGoal goal = c.arms[s];
  ArmMemory memory;
  Quaternionf R_SW = set_arm(figure, a, c, goal, s, before, solved, memory);
  // Lifted, its wrist may turn the hand farther: after a few times what is left does not show.
  constexpr int most_rounds = 4;
  constexpr float enough_m = 0.0002F;
  for (int round = 0; round < most_rounds; ++round) {
    const float lift = lift_out_of_table(c, c.arms[s], ends_W, wrist_S, R_SW);
    if (lift < enough_m) break;
    goal.wrist_S.z() += lift;
    R_SW = set_arm(figure, a, c, goal, s, before, solved, memory);
  }
  apply(figure, hand, goal.shape, solved.pose);
  return memory;
}

}  // namespace

Quaternionf rotation_of(float heading_rad, const Turn& t) {
  return Quaternionf(AngleAxisf(heading_rad + t.yaw, Vector3f::UnitZ()) * AngleAxisf(-t.pitch, Vector3f::UnitX()) *
                     AngleAxisf(t.roll, Vector3f::UnitY()));
}

void solve_body(const Figure& figure, const Anatomy& a, const BodyControls& c, SolvedBody& solved) {
  BodyPose& pose = solved.pose;
  if (pose.turn.size() != figure.joints.size()) pose = bind_pose(figure);
  Lean lean = find_lean(figure, a, c, pose);
  if (solved.before && c.dt_s > 0) lean = held_back(lean, *solved.before, c.dt_s);
  set_trunk(figure, a, c, lean, pose);
  set_legs(figure, a, c, solved);
  set_head(figure, a, c, lean, pose);
  BodyMemory memory;
  memory.lean = lean.pull;
  memory.rise = lean.rise;
  for (const std::size_t s : {left_side, right_side}) memory.arms[s] = set_arm(figure, a, c, s, solved);
  solved.before = memory;
  update(figure, pose);
}

}  // namespace counterpart
