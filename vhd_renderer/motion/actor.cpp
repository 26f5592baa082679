#include "vhd_renderer/motion/actor.hpp"

#include <cmath>

#include "vhd_renderer/motion/idle.hpp"
#include "vhd_renderer/motion/pose.hpp"

namespace counterpart {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

bool has_morph(const Figure& figure, const std::string& name) {
  for (const FigurePart& part : figure.parts) {
    for (const Morph& morph : part.morphs) {
      if (morph.name == name) return true;
    }
  }
  return false;
}

// Hands in the lap, while he sits down or gets up.
ArmGoal lap_arm(const BodyControls& c, const Anatomy& a, std::size_t side) {
  const float s = side == right_side ? 1.F : -1.F;
  ArmGoal goal;
  goal.wrist_S = c.pelvis_S + Vector3f(s * 0.15F, 0.46F * a.legs[side].limb.upper_m, 0.125F);
  const Vector3f x = Vector3f(-s * 0.3F, 0.93F, -0.2F).normalized();
  const Vector3f palm(0, 0, -1);
  const Vector3f z = (-palm + x * x.dot(palm)).normalized();
  Eigen::Matrix3f R;
  R << x, z.cross(x), z;
  goal.R_SW = Quaternionf(R);
  goal.help = 0;
  goal.shape = hand_shape("relaxed");
  return goal;
}

}  // namespace

Actor::Actor(const Figure& figure, const Anatomy& anatomy, unsigned seed)
    : figure_(&figure), anatomy_(&anatomy), seed_(seed), has_mouth_shape_(has_morph(figure, "mouth-open")) {
  solved_.pose = bind_pose(figure);
  trial_.pose = solved_.pose;
  for (const std::size_t s : {left_side, right_side}) {
    rest_depth_m_[s] = resting_depth_m(figure, anatomy.arms[s].hand, s);
  }
  set_scene(Scene{});
  place_ = home_.entrance;
}

void Actor::set_scene(const Scene& scene) {
  const bool at_entrance =
      !going() && posture_ == Posture::standing && (place_.p_S - home_.entrance.p_S).norm() < 0.01F;
  home_ = home_of(scene, *anatomy_, rest_depth_m_);
  if (at_entrance) place_ = home_.entrance;
}

void Actor::go(std::deque<Stretch> stretches, const Place& end_place, Posture end_posture, double now_s) {
  stretches_ = std::move(stretches);
  stretch_start_s_ = now_s;
  end_place_ = end_place;
  end_posture_ = end_posture;
}

void Actor::appear(const Place& place, Posture posture, double now_s) {
  stretches_.clear();
  place_ = place;
  posture_ = posture;
  channels_ = {};
  solved_.before.reset();
  looked_ = false;
  begin(now_s);
  // What starts in the same step starts from hands that rest.
  for (const std::size_t s : {left_side, right_side}) move_arm(s, {}, now_s);
}

void Actor::move_arm(std::size_t side, const ArmDrive& drive, double now_s) {
  const Quaternionf heading(Eigen::AngleAxisf(controls_.heading_rad, Vector3f::UnitZ()));
  ArmGoal goal = drive.source != 0 ? drive.goal : rest(side);
  goal.wrist_S = heading.conjugate() * (goal.wrist_S - controls_.pelvis_S);
  goal.R_SW = heading.conjugate() * goal.R_SW;
  goal = channels_[side].step(drive.source != 0 ? drive.source + 16 : rest_source(), goal, now_s);
  goal.wrist_S = controls_.pelvis_S + heading * goal.wrist_S;
  goal.R_SW = (heading * goal.R_SW).normalized();
  shown_arms_[side] = goal;
}

std::uint64_t Actor::rest_source() const {
  return posture_ == Posture::seated && !going() ? 1 : seatedness_ > 0.35F ? 2 : 3;
}

BodyControls& Actor::begin(double now_s) {
  if (start_s_ < 0) start_s_ = now_s;
  controls_ = BodyControls{};
  controls_.chair_y = home_.chair_back_y;
  while (!stretches_.empty() && now_s - stretch_start_s_ >= stretches_.front().duration_s()) {
    stretch_start_s_ += stretches_.front().duration_s();
    stretches_.pop_front();
    if (stretches_.empty()) {
      place_ = end_place_;
      posture_ = end_posture_;
    }
  }
  swing_ = 0;
  if (!stretches_.empty()) {
    swing_ = stretches_.front().pose(now_s - stretch_start_s_, home_, *anatomy_, controls_, seatedness_);
  } else if (posture_ == Posture::seated) {
    seatedness_ = 1;
    sit(home_, *anatomy_, controls_);
  } else {
    seatedness_ = 0;
    stand(place_, home_, *anatomy_, controls_);
  }
  controls_.table_z_m = home_.table_z;
  controls_.board_half_m = home_.board_half_m;
  controls_.table_edge_y_m = posture_ == Posture::seated && !going() ? home_.table_edge_y : 1e3F;
  add_idle(now_s - start_s_, seed_, seatedness_, controls_);
  return controls_;
}

ArmGoal Actor::rest(std::size_t side) const {
  if (posture_ == Posture::seated && !going()) return resting_arm(home_, side);
  if (seatedness_ > 0.35F) return lap_arm(controls_, *anatomy_, side);
  return hanging_arm(*anatomy_, controls_, side, swing_);
}

const SolvedBody& Actor::finish(const ActorInputs& inputs) {
  for (const std::size_t s : {left_side, right_side}) {
    move_arm(s, inputs.arms[s], inputs.now_s);
    controls_.arms[s] = shown_arms_[s];
  }
  controls_.dt_s = inputs.dt_s;
  look(inputs);
  wear_face(inputs);
  solve_body(*figure_, *anatomy_, controls_, solved_);
  return solved_;
}

void Actor::look(const ActorInputs& in) {
  const Quaternionf heading(Eigen::AngleAxisf(controls_.heading_rad, Vector3f::UnitZ()));
  Vector3f target = in.gaze_S;
  const double t = in.now_s - start_s_;
  if (!in.gaze_given) {
    if (posture_ == Posture::seated && !going()) {
      // Mostly the board, now and then the other player.
      const bool at_player = noise(std::floor(t / 2.7), seed_ + 41) > 0.45F;
      const double i = std::floor(t / 1.4);
      target =
          at_player ? in.player_S : Vector3f(0.11F * noise(i, seed_ + 42), 0.02F + 0.11F * noise(i, seed_ + 43), 0);
    } else {
      target = controls_.pelvis_S + heading * Vector3f(0, 2.4F, 0.45F);
    }
  }
  if (!looked_) {
    looked_ = true;
    head_gaze_.value = eye_gaze_.value = target;
    head_gaze_.velocity = eye_gaze_.velocity = Vector3f::Zero();
  }
  head_gaze_.step(target, 0.42F, in.dt_s);
  eye_gaze_.step(target, 0.09F, in.dt_s);
  controls_.head_gaze_S = head_gaze_.value;
  const float distance = (eye_gaze_.value - solved_.pose.p_S[at(anatomy_->neck.back())]).norm();
  controls_.gaze_S = eye_gaze_.value + saccade(t, seed_) * distance;
}

void Actor::wear_face(const ActorInputs& in) {
  std::map<std::string, float> weights;
  for (auto& [name, follower] : face_) {
    if (in.face.count(name) == 0) follower.step(0.F, 0.3F, in.dt_s);
  }
  for (const auto& [name, weight] : in.face) face_[name].step(weight, 0.3F, in.dt_s);
  for (const auto& [name, follower] : face_) controls_.morphs[name] += follower.value;
  // A face at rest is not a grim one.
  controls_.morphs["mouth-corner-puller"] += 0.16F;
  for (const char* lid : {"eye-left-opened-up", "eye-right-opened-up"}) controls_.morphs[lid] += 0.12F;
  float closed = blink(in.now_s - start_s_, seed_);
  // Lids go down with the eyes.
  if (anatomy_->eyes[0] >= 0) {
    const Quaternionf& q = solved_.pose.turn[at(anatomy_->eyes[0])];
    const Vector3f forward = q * Vector3f::UnitY();
    closed = std::max(closed, 0.38F * unit_clamp(-std::asin(std::clamp(forward.z(), -1.F, 1.F)) / radians(32)));
  }
  for (const char* lid : {"eye-left-closure", "eye-right-closure"}) {
    controls_.morphs[lid] = std::max(controls_.morphs[lid], closed);
  }
  controls_.morphs["mouth-open"] += 0.55F * in.mouth.open;
  controls_.morphs["mouth-retraction"] += 0.45F * in.mouth.wide;
  controls_.morphs["mouth-pursing"] += 0.6F * in.mouth.round;
  controls_.morphs["mouth-compression"] += 0.6F * in.mouth.press;
  if (!has_mouth_shape_) controls_.jaw_rad = radians(12) * in.mouth.open;
  for (auto& [name, weight] : controls_.morphs) weight = unit_clamp(weight);
}

ClipFrame Actor::clip_frame(bool head) const {
  const Anatomy& a = *anatomy_;
  const BodyPose& pose = solved_.pose;
  ClipFrame frame;
  frame.arm_m = a.arms[right_side].limb.length_m();
  const Quaternionf heading(Eigen::AngleAxisf(controls_.heading_rad, Vector3f::UnitZ()));
  if (head) {
    frame.R_S = pose.G[at(a.neck.back())];
    frame.origin_S = pose.p_S[at(a.neck.back())] + frame.R_S * Vector3f(0, 0.10F, 0.075F);
    return frame;
  }
  frame.origin_S = 0.5F * (pose.p_S[at(a.arms[0].limb.root)] + pose.p_S[at(a.arms[1].limb.root)]);
  frame.R_S = heading;
  return frame;
}

void Actor::keep_off_table(ArmGoal& goal) const {
  if (posture_ != Posture::seated || going()) return;
  constexpr float hand_m = 0.055F;  // half a hand, its fingers bent
  const float over = unit_clamp((goal.wrist_S.y() - home_.table_edge_y + 0.10F) / 0.10F);
  const float least = home_.table_z + hand_m;
  const float missing = least - goal.wrist_S.z();
  if (missing > 0) goal.wrist_S.z() += over * missing;
}

float Actor::reach_gap_m(std::size_t side, const ArmGoal& goal) {
  BodyControls trial = controls_;
  if (posture_ == Posture::seated && !going()) {
    sit(home_, *anatomy_, trial);
  } else {
    stand(place_, home_, *anatomy_, trial);
  }
  trial.arms[1 - side] = rest(1 - side);
  trial.arms[side] = goal;
  trial_.before.reset();
  solve_body(*figure_, *anatomy_, trial, trial_);
  return trial_.arm_gap_m[side];
}

}  // namespace counterpart
