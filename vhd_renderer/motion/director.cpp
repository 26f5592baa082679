#include "vhd_renderer/motion/director.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "vhd_renderer/motion/director_state.hpp"
#include "vhd_renderer/motion/pose.hpp"

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Isometry3f;
using Eigen::Vector3f;

}  // namespace

const std::map<std::string, float>* face_of(const std::string& expression) {
  static const std::map<std::string, std::map<std::string, float>> faces{
      {"neutral", {}},
      {"smile", {{"mouth-corner-puller", 0.85F}, {"eye-left-slit", 0.25F}, {"eye-right-slit", 0.25F}}},
      {"frown", {{"eyebrows-left-down", 0.9F}, {"eyebrows-right-down", 0.9F}, {"mouth-compression", 0.4F}}},
      {"surprise",
       {{"eyebrows-left-up", 0.9F},
        {"eyebrows-right-up", 0.9F},
        {"eye-left-opened-up", 0.7F},
        {"eye-right-opened-up", 0.7F},
        {"mouth-open", 0.3F}}},
      {"doubt", {{"eyebrows-left-up", 0.8F}, {"eyebrows-right-down", 0.5F}, {"mouth-pursing", 0.3F}}},
      {"sad", {{"eyebrows-left-inner-up", 0.9F}, {"eyebrows-right-inner-up", 0.9F}, {"mouth-depression", 0.7F}}}};
  const auto found = faces.find(expression);
  return found == faces.end() ? nullptr : &found->second;
}

void Director::State::set_scene(const Scene& next) {
  scene = next;
  dark = scene.virtual_side == Side::dark;
  // What is in a hand stays there as long as it exists; everything else stands where the scene says.
  std::vector<PieceOnStage> now;
  for (const ScenePiece& piece : scene.pieces) {
    PieceOnStage one{piece, S_from_B(piece.p_B), 0};
    if (const PieceOnStage* before = find_piece(piece.name); before != nullptr) {
      one.turn_rad = before->turn_rad;
      for (const auto& grasp : grasps) {
        if (grasp && grasp->piece == piece.name && grasp->holds) one.foot_S = before->foot_S;
      }
    }
    now.push_back(std::move(one));
  }
  pieces = std::move(now);
  if (!has_body) return;
  actor->set_scene(scene);
  const auto radius = static_cast<float>(scene.board.piece_radius_m);
  const auto height = static_cast<float>(scene.board.piece_height_m);
  const auto square = static_cast<float>(scene.board.square_size_m);
  if (grips_fit && gripped.radius_m == radius && gripped.height_m == height && gripped.square_m == square) return;
  gripped = {radius, height, square};
  grips_fit = true;
  for (const std::size_t s : {left_side, right_side}) {
    grips[s] = grip_source(*figure, anatomy.arms[s].hand, gripped);
  }
}

// The hand frame W in S as it was solved.
Isometry3f Director::State::hand_S(std::size_t side) const {
  const HandParts& hand = anatomy.arms[side].hand;
  const BodyPose& pose = actor->solved().pose;
  Isometry3f X_SW = Isometry3f::Identity();
  X_SW.linear() = pose.G[at(hand.wrist)].toRotationMatrix() * hand.R_HW;
  X_SW.translation() = pose.p_S[at(hand.wrist)];
  return X_SW;
}

void Director::State::carry_piece(RunningGrasp& grasp, std::size_t side) {
  const GraspMoment moment = grasp.motion.at(now_s - grasp.start_s);
  const Isometry3f X_SP = hand_S(side) * grasp.motion.X_WP();
  const Vector3f foot_S = X_SP.translation();
  if (moment.phase == GraspPhase::close || moment.phase == GraspPhase::release) {
    grasp.gap_mm = 1000.0 * static_cast<double>((foot_S - moment.target_S).norm());
  }
  PieceOnStage* piece = find_piece(grasp.piece);
  if (piece == nullptr) return;
  const float heading = std::atan2(X_SP.linear()(1, 0), X_SP.linear()(0, 0));
  if (moment.holds && !grasp.settled) {
    if (!grasp.holds) grasp.turn_offset_rad = piece->turn_rad - heading;
    grasp.holds = true;
    piece->foot_S = foot_S;
    piece->turn_rad = heading + grasp.turn_offset_rad;
  } else if (grasp.holds) {
    // Let go: it lies where it was brought to.
    grasp.holds = false;
    grasp.settled = true;
    piece->foot_S = grasp.motion.task().path.back().foot_S;
    piece->turn_rad = heading + grasp.turn_offset_rad;
  }
}

void Director::State::advance_grasp(std::size_t side, ActorInputs& inputs) {
  auto& grasp = grasps[side];
  if (!grasp) return;
  if (!grasp->piece.empty() && find_piece(grasp->piece) == nullptr && !grasp->settled) {
    if (grasp->id != 0) queue.end(grasp->id, FeedbackState::failed, "unknown_piece", -1, now_ns);
    grasp.reset();
    return;
  }
  const GraspMoment moment = grasp->motion.at(now_s - grasp->start_s);
  if (moment.phase == GraspPhase::done) {
    if (grasp->id != 0) queue.end(grasp->id, FeedbackState::finished, "", grasp->gap_mm, now_ns);
    grasp.reset();
    return;
  }
  inputs.arms[side] = {grasp->source, moment.goal};
  const bool later_gaze = gaze && gaze->start_s > grasp->start_s;
  if (moment.phase != GraspPhase::retract && !later_gaze) {
    inputs.gaze_given = true;
    inputs.gaze_S = moment.target_S;
  }
}

// After the body has been solved: what the hands really did.
void Director::State::measure_grasps() {
  for (const std::size_t s : {left_side, right_side}) {
    auto& grasp = grasps[s];
    if (!grasp) continue;
    carry_piece(*grasp, s);
    const GraspPhase phase = grasp->motion.at(now_s - grasp->start_s).phase;
    if (phase == grasp->reported || grasp->id == 0) continue;
    grasp->reported = phase;
    const bool measured = phase == GraspPhase::close || phase == GraspPhase::release;
    queue.progress(grasp->id, phase_name(phase), measured ? grasp->gap_mm : -1, now_ns);
  }
}

void Director::State::advance_clips(BodyControls& controls, ActorInputs& inputs) {
  for (auto clip = clips.begin(); clip != clips.end();) {
    double t = (now_s - clip->start_s) * clip->how.speed;
    const double length = static_cast<double>(clip->clip->seconds);
    if (clip->how.loop) t = std::fmod(t, length);
    const float fading =
        clip->fade_from_s < 0 ? 1.F : 1 - minimum_jerk(static_cast<float>(now_s - clip->fade_from_s) / 0.35F);
    if (t >= length || fading <= 0) {
      if (clip->id != 0) queue.end(clip->id, FeedbackState::finished, "", -1, now_ns);
      clip = clips.erase(clip);
      continue;
    }
    const auto weight = static_cast<float>(clip->how.weight);
    add_clip(*clip->clip, static_cast<float>(t), weight * fading, clip->mask, controls, clip->variation);
    for (const std::size_t s : {left_side, right_side}) {
      // A mirrored clip moves the other arm; then the mask says which of its hands may be shown.
      const unsigned bit = (s == left_side) != clip->variation.mirrored ? part::left_arm : part::right_arm;
      if ((clip->mask & bit) == 0 || clip->fade_from_s >= 0 || grasps[s]) continue;
      if (clip->clip->yields && actor->going()) continue;
      ArmGoal goal = actor->rest(s);
      if (!clip_hand(*clip->clip, static_cast<float>(t), s, actor->clip_frame(clip->clip->in_head_frame), goal,
                     clip->variation))
        continue;
      actor->keep_off_table(goal);
      if (weight < 1) {
        const ArmGoal rest = actor->rest(s);
        goal.wrist_S = rest.wrist_S + (goal.wrist_S - rest.wrist_S) * weight;
        goal.R_SW = rest.R_SW.slerp(weight, goal.R_SW);
      }
      inputs.arms[s] = {clip->source, goal};
    }
    ++clip;
  }
}

Vector3f Director::State::gaze_target(const Gaze& g) const {
  switch (g.target) {
    case GazeTarget::square:
      return S_from_B(centre_of_square_B(g.square, scene.board));
    case GazeTarget::piece:
      for (const PieceOnStage& piece : pieces) {
        if (piece.piece.name == g.piece) return piece.foot_S;
      }
      return {0, 0, 0};
    case GazeTarget::player:
      return player_S;
    case GazeTarget::camera:
      return camera_S;
    case GazeTarget::point:
      return S_from_B(g.point_B);
    case GazeTarget::ahead:
      break;
  }
  const Eigen::Quaternionf heading(AngleAxisf(actor->controls().heading_rad, Vector3f::UnitZ()));
  return actor->controls().pelvis_S + heading * Vector3f(0, 2.5F, 0.6F);
}

// Gaze, face and voice.
void Director::State::advance_rest(ActorInputs& inputs) {
  if (gaze) {
    const double t = now_s - gaze->start_s;
    if (!inputs.gaze_given) {
      inputs.gaze_given = true;
      inputs.gaze_S = gaze_target(gaze->gaze);
    }
    const bool held = gaze->gaze.hold_s > 0;
    if (gaze->id != 0 && t >= (held ? gaze->gaze.hold_s : 0.5)) {
      queue.end(gaze->id, FeedbackState::finished, "", -1, now_ns);
      gaze->id = 0;
      if (held) gaze.reset();
    }
  }
  if (face) {
    const double t = now_s - face->start_s;
    for (const auto& [shape, weight] : *face_of(face->express.face)) {
      inputs.face[shape] = weight * static_cast<float>(face->express.weight);
    }
    const bool held = face->express.hold_s > 0;
    if (face->id != 0 && t >= (held ? face->express.hold_s : 0.5)) {
      queue.end(face->id, FeedbackState::finished, "", -1, now_ns);
      face->id = 0;
      if (held) face.reset();
    }
  }
  if (speech) advance_speech(inputs);
}

void Director::State::advance_speech(ActorInputs& inputs) {
  constexpr double longest_wait_s = 1.5;  // for a sound; after that he speaks without
  if (!speech->utterance) {
    const bool ready = speech->to_come.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (!ready && now_s - speech->told_s < longest_wait_s) return;
    if (ready) speech->sound = speech->to_come.get();
    speech->utterance.emplace(speech->say.text, speech->sound.get());
    speech->start_s = now_s;
  }
  const double t = now_s - speech->start_s;
  inputs.mouth = speech->utterance->at(t);
  if (t < speech->utterance->duration_s()) return;
  queue.end(speech->id, FeedbackState::finished, "", -1, now_ns);
  speech.reset();
}

Performance Director::State::performance() const {
  Performance p;
  const Isometry3f X_BS(AngleAxisf(dark ? pi_f : 0.F, Vector3f::UnitZ()));
  for (std::size_t j = 0; j < figure->joints.size(); ++j) {
    p.X_BJ.push_back(X_BS * (has_body ? joint_frame_S(*figure, actor->solved().pose, j) : figure->joints[j].X_HJ));
  }
  if (has_body) {
    const Eigen::Translation3f chair_S(0, actor->controls().chair_y, actor->home().floor_z);
    p.X_BC = X_BS * chair_S;
  }
  p.morphs.assign(morph_names.size(), 0.F);
  if (has_body) {
    for (const auto& [name, weight] : actor->controls().morphs) {
      const auto found = std::lower_bound(morph_names.begin(), morph_names.end(), name);
      if (found != morph_names.end() && *found == name) {
        p.morphs[static_cast<std::size_t>(found - morph_names.begin())] = weight;
      }
    }
  }
  for (const PieceOnStage& piece : pieces) {
    if (piece.piece.real) continue;
    StagedPiece staged{piece.piece.name, piece.piece.side, piece.piece.king, Isometry3f::Identity()};
    staged.X_BP.linear() = AngleAxisf(piece.turn_rad, Vector3f::UnitZ()).toRotationMatrix();
    staged.X_BP.translation() = piece.foot_S;
    staged.X_BP = X_BS * staged.X_BP;
    p.pieces.push_back(std::move(staged));
  }
  if (speech) {
    p.subtitle = speech->say.text;
    p.sound = speech->sound;
    p.sound_s = now_s - speech->start_s;
  }
  return p;
}

Director::Director(const Figure& figure, Speaker speaker, ClipLibrary clips, GripSource grips)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.speaker = std::move(speaker);
  s.library = std::move(clips);
  s.grip_source = std::move(grips);
  s.figure = &figure;
  s.morph_names = morph_names_of(figure);
  if (auto anatomy = anatomy_of(figure); anatomy) {
    s.anatomy = std::move(*anatomy);
    s.has_body = true;
    s.actor.emplace(figure, s.anatomy, 7U);
  }
  s.set_scene(Scene{});
}

Director::Director(Director&&) noexcept = default;
Director::~Director() = default;

const std::vector<std::string>& Director::morph_names() const {
  return state_->morph_names;
}

Performance Director::step(const DirectorInputs& in) {
  State& s = *state_;
  const std::int64_t before = s.now_ns;
  s.now_ns = in.now_ns;
  s.now_s = 1e-9 * static_cast<double>(in.now_ns);
  // The first frame has no frame before it; time that runs back stands still.
  s.dt_s = s.started ? static_cast<float>(std::clamp(1e-9 * static_cast<double>(in.now_ns - before), 0.0, 0.5)) : 0.F;
  s.started = true;
  if (in.scene != nullptr) s.set_scene(*in.scene);
  s.camera_S = s.S_from_B(in.camera_B);
  s.player_S = s.S_from_B(in.player_B);
  if (!s.has_body) {
    for (const Command& command : in.commands) s.submit(command);
    Performance p = s.performance();
    p.feedback = s.queue.take_feedback();
    return p;
  }

  BodyControls& controls = s.actor->begin(s.now_s);
  if (s.navigating != 0 && !s.actor->going()) {
    s.queue.end(s.navigating, FeedbackState::finished, "", -1, s.now_ns);
    s.navigating = 0;
  }
  for (const Command& command : in.commands) s.submit(command);
  s.queue.check_deadlines(s.now_ns, [&](std::uint64_t id) { s.cancel_body(id); });

  ActorInputs inputs;
  inputs.now_s = s.now_s;
  inputs.dt_s = s.dt_s;
  inputs.player_S = s.player_S;
  for (const std::size_t side : {left_side, right_side}) s.advance_grasp(side, inputs);
  s.advance_clips(controls, inputs);
  // What has just ended makes room in the same frame; what starts now moves from the next one on.
  s.queue.start_ready(s.now_ns, s.held_parts(),
                      [&](CommandQueue::Entry& entry, unsigned free) { s.start(entry, free); });
  s.advance_rest(inputs);
  if (s.navigating != 0 && s.actor->going() && s.going_phase != s.actor->going_phase()) {
    s.going_phase = s.actor->going_phase();
    s.queue.progress(s.navigating, s.going_phase, -1, s.now_ns);
  }
  s.actor->finish(inputs);
  s.measure_grasps();
  Performance p = s.performance();
  p.feedback = s.queue.take_feedback();
  return p;
}

}  // namespace counterpart
