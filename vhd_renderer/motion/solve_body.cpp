#include <cmath>

#include "vhd_renderer/motion/body_controls.hpp"
#include "vhd_renderer/motion/curves.hpp"
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

struct Lean {
  std::array<float, 2> pull{0, 0};  // of each arm; 0..1 together

  float amount() const { return pull[left_side] + pull[right_side]; }
};

// Root, spine and shoulder girdle.
void set_trunk(const Figure& figure, const Anatomy& a, const BodyControls& c, const Lean& lean, BodyPose& pose) {
  Turn pelvis = c.pelvis;
  pelvis.pitch += lean.amount() * lean_pelvis;
  const Quaternionf G = rotation_of(c.heading_rad, pelvis);
  const Vector3f hips_H = 0.5F * (figure.joints[at(a.legs[0].limb.root)].X_HJ.translation() +
                                  figure.joints[at(a.legs[1].limb.root)].X_HJ.translation());
  pose.turn[at(a.root)] = G;
  pose.root_p_S = c.pelvis_S + G * (figure.joints[at(a.root)].X_HJ.translation() - hips_H);
  Turn spine = c.spine;
  spine.pitch += lean.amount() * lean_spine;
  spine.yaw += lean_twist * (lean.pull[right_side] - lean.pull[left_side]);
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
  const auto lean_of = [&](float amount) {
    return Lean{{amount * share[left_side] / excess_sum, amount * share[right_side] / excess_sum}};
  };
  const auto missing = [&](float amount) {
    set_trunk(figure, a, c, lean_of(amount), pose);
    float worst = -1;
    for (const std::size_t s : {left_side, right_side}) worst = std::max(worst, reach_of(a, c, pose, s) - wanted[s]);
    return worst;
  };
  constexpr int parts = 6;
  float best = 0;
  float least = missing(0);
  for (int k = 1; k <= parts && least > 0; ++k) {
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
Lean held_back(const Lean& wanted, const std::array<float, 2>& before, float dt_s) {
  constexpr float fastest_a_second = 4;
  Lean lean = wanted;
  for (const std::size_t s : {left_side, right_side}) {
    lean.pull[s] = std::clamp(lean.pull[s], before[s] - fastest_a_second * dt_s, before[s] + fastest_a_second * dt_s);
  }
  return lean;
}

void set_legs(const Figure& figure, const Anatomy& a, const BodyControls& c, SolvedBody& solved) {
  BodyPose& pose = solved.pose;
  for (const std::size_t s : {left_side, right_side}) {
    const LegParts& leg = a.legs[s];
    const FootGoal& foot = c.feet[s];
    const Quaternionf G(AngleAxisf(foot.heading_rad, Vector3f::UnitZ()) *
                        AngleAxisf(-foot.pitch_rad, Vector3f::UnitX()));
    const Vector3f ankle_H = figure.joints[at(leg.limb.end)].X_HJ.translation();
    LimbGoal goal;
    // The foot rolls over a place between its toes' joint and the sole under it, so that neither slides far.
    const Vector3f joint_H =
        leg.toe >= 0 ? Vector3f(figure.joints[at(leg.toe)].X_HJ.translation()) : Vector3f(leg.ball_H);
    const Vector3f pivot_H = 0.5F * (joint_H + leg.ball_H);
    goal.end_S = foot.ball_S + Vector3f(0, 0, pivot_H.z() - leg.ball_H.z()) + G * (ankle_H - pivot_H);
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
    for (const int toe : leg.toes) {
      pose.turn[at(toe)] = AngleAxisf(std::max(0.F, foot.pitch_rad), Vector3f::UnitX());
    }
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

void set_head(const Figure& figure, const Anatomy& a, const BodyControls& c, BodyPose& pose) {
  const Quaternionf trunk = pose.G[at(a.spine.back())];
  const Vector3f neck = pose.p_S[at(a.spine.back())];
  const Vector3f head_H =
      figure.joints[at(a.neck.back())].X_HJ.translation() - figure.joints[at(a.spine.back())].X_HJ.translation();
  const Vector3f eyes = neck + trunk * (head_H + Vector3f(0, 0.08F, 0.08F));
  Turn look = direction_turn(trunk.conjugate() * (c.head_gaze_S - eyes));
  look.yaw = soft_limit(std::abs(look.yaw), 0.6F, 1.2F) * (look.yaw < 0 ? -1.F : 1.F) * before_him(look.yaw);
  look.pitch = std::clamp(look.pitch, -radians(42), radians(42));
  const Turn turn = look * c.head_share + c.head;
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

// How an elbow is lifted out of its natural place: about the line from shoulder to wrist, radians.
struct Swivel {
  Vector3f natural;  // direction of the elbow that hangs down and a little outward
  Vector3f line;     // unit, shoulder to wrist
  float side;

  Vector3f turned(float angle) const { return AngleAxisf(-side * angle, line) * natural; }
  float of(const Vector3f& elbow) const {
    const Vector3f a = natural - line * line.dot(natural);
    const Vector3f b = elbow - line * line.dot(elbow);
    return -side * std::atan2(a.cross(b).dot(line), a.dot(b));
  }
};

// The least lift, from `low` on, that keeps elbow and forearm out of the table.
float clear_of_table(const Anatomy& a, const BodyControls& c, std::size_t s, const Vector3f& shoulder,
                     const Swivel& swivel, float low) {
  const ArmGoal& goal = c.arms[s];
  // A hand below the table top is under the table, and so may its arm be.
  const float above = unit_clamp((goal.wrist_S.z() - c.table_z_m + 0.01F) / 0.03F);
  const auto clearance = [&](float lift) {
    const Vector3f elbow = middle_place(a.arms[s].limb, shoulder, goal.wrist_S, swivel.turned(lift));
    float least = 1;
    for (const float share : {0.F, 0.25F, 0.5F, 0.75F}) {  // of the forearm, which is thinner towards the wrist
      const Vector3f p = elbow + (goal.wrist_S - elbow) * share;
      // The table begins softly, so that the elbow does not jump at its edge.
      const float over = above * unit_clamp((p.y() - c.table_edge_y_m + 0.07F) / 0.07F);
      least = std::min(least, p.z() - (c.table_z_m + lerp(0.06F, 0.035F, share)) + (1 - over) * 0.5F);
    }
    return least;
  };
  if (clearance(low) >= 0) return low;
  constexpr float most = radians(80);
  float high = std::max(low, most);
  for (int round = 0; round < 12; ++round) {
    const float middle = 0.5F * (low + high);
    (clearance(middle) < 0 ? low : high) = middle;
  }
  return high;
}

// Where the elbow points: hanging, lifted by what the goal says or the table asks for, never in a jump. `solved` still
// holds the frame before below the shoulder.
Vector3f elbow_pole(const Anatomy& a, const BodyControls& c, const SolvedBody& solved, std::size_t s) {
  const Limb& arm = a.arms[s].limb;
  const ArmGoal& goal = c.arms[s];
  const Vector3f shoulder = solved.pose.p_S[at(arm.root)];
  const float side = s == right_side ? 1.F : -1.F;
  const Quaternionf heading(AngleAxisf(c.heading_rad, Vector3f::UnitZ()));
  const Swivel swivel{heading * Vector3f(side * 0.62F, -0.35F, -0.75F), (goal.wrist_S - shoulder).normalized(), side};
  float lift = clear_of_table(a, c, s, shoulder, swivel, goal.swivel_rad);
  if (solved.before && c.dt_s > 0) {
    constexpr float fastest_rad_s = 4.4F;
    const Vector3f hinge_before = solved.pose.G[at(arm.middle)] * arm.hinge_H;
    const float before = swivel.of(swivel.line.cross(hinge_before));
    lift = std::clamp(lift, before - fastest_rad_s * c.dt_s, before + fastest_rad_s * c.dt_s);
  }
  return swivel.turned(lift);
}

// Returns how the wrist is bent.
WristAngles set_arm(const Figure& figure, const Anatomy& a, const BodyControls& c, std::size_t s, SolvedBody& solved) {
  const ArmGoal& goal = c.arms[s];
  const HandParts& hand = a.arms[s].hand;
  LimbGoal limb;
  limb.end_S = goal.wrist_S;
  limb.end_G = (goal.R_SW * Quaternionf(hand.R_HW).conjugate()).normalized();
  limb.pole_S = elbow_pole(a, c, solved, s);
  const float wrist_gap_m = solve_limb(figure, a.arms[s].limb, limb, solved.pose);

  // A hand goes only where its wrist lets it; then the forearm is solved again under it.
  const BodyPose& pose = solved.pose;
  const Limb& arm = a.arms[s].limb;
  const Vector3f hinge = pose.G[at(arm.middle)] * arm.hinge_H;
  const Vector3f lower = (pose.p_S[at(arm.end)] - pose.p_S[at(arm.middle)]).normalized();
  const WristAngles wanted = wrist_angles(hinge, lower, goal.R_SW.toRotationMatrix(), hand.thumb_side);
  const WristAngles legal =
      solved.before ? held_back(wanted, solved.before->wrists[s], c.dt_s) : held_back(wanted, wanted, 0);
  const Quaternionf R_SW(hand_frame(hinge, lower, legal, hand.thumb_side));
  constexpr float palm_m = 0.12F;  // from the wrist to what the hand holds
  solved.arm_gap_m[s] = wrist_gap_m + palm_m * R_SW.angularDistance(goal.R_SW);
  limb.end_G = (R_SW * Quaternionf(hand.R_HW).conjugate()).normalized();
  solve_limb(figure, arm, limb, solved.pose);
  apply(figure, hand, goal.shape, solved.pose);
  return legal;
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
  if (solved.before && c.dt_s > 0) lean = held_back(lean, solved.before->lean, c.dt_s);
  set_trunk(figure, a, c, lean, pose);
  set_legs(figure, a, c, solved);
  set_head(figure, a, c, pose);
  BodyMemory memory;
  memory.lean = lean.pull;
  for (const std::size_t s : {left_side, right_side}) memory.wrists[s] = set_arm(figure, a, c, s, solved);
  solved.before = memory;
  update(figure, pose);
}

}  // namespace counterpart
