// The body between commands: where it is, what each arm does by itself, where it looks, its face. The director tells
// it what to add; it makes the controls of a frame.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "vhd_renderer/motion/arm_channel.hpp"
#include "vhd_renderer/motion/body_controls.hpp"
#include "vhd_renderer/motion/clip.hpp"
#include "vhd_renderer/motion/curves.hpp"
#include "vhd_renderer/motion/speech.hpp"
#include "vhd_renderer/motion/stance.hpp"

namespace counterpart {

// What drives an arm in this frame; source 0: nothing but the body's own rest.
struct ArmDrive {
  std::uint64_t source = 0;
  ArmGoal goal;
};

struct ActorInputs {
  double now_s = 0;
  float dt_s = 0.04F;
  std::array<ArmDrive, 2> arms;
  Eigen::Vector3f gaze_S{0, 0, 0};
  bool gaze_given = false;  // else he looks where he likes
  Eigen::Vector3f player_S{0, 0.8F, 0.4F};
  std::map<std::string, float> face;  // weights he is told to wear
  MouthShape mouth;
};

class Actor {
 public:
  Actor(const Figure& figure, const Anatomy& anatomy, unsigned seed);

  void set_scene(const Scene& scene);  // board and table, from which his places follow
  const Home& home() const { return home_; }

  Posture posture() const { return posture_; }
  const Place& place() const { return place_; }

  // Goes along stretches one after the other from `now_s` on.
  void go(std::deque<Stretch> stretches, const Place& end_place, Posture end_posture, double now_s);
  // Is there at once, wherever he was.
  void appear(const Place& place, Posture posture, double now_s);
  bool going() const { return !stretches_.empty(); }
  const char* going_phase() const { return stretches_.empty() ? "" : stretches_.front().phase(); }

  // Begins a frame: posture, idle life. Clips are then added to `controls()`, and `finish` solves the body.
  BodyControls& begin(double now_s);
  const SolvedBody& finish(const ActorInputs& inputs);

  const SolvedBody& solved() const { return solved_; }
  const BodyControls& controls() const { return controls_; }
  const ArmGoal& arm(std::size_t side) const { return shown_arms_[side]; }
  ArmGoal rest(std::size_t side) const;
  ClipFrame clip_frame(bool head) const;

  // Lifts the goal of a free hand that would be in the table he sits at.
  void keep_off_table(ArmGoal& goal) const;

  // How far the wrist would stay from a goal if he reached for it from where he is, metres.
  float reach_gap_m(std::size_t side, const ArmGoal& goal);

 private:
  void move_arm(std::size_t side, const ArmDrive& drive, double now_s);
  std::uint64_t rest_source() const;  // which rest the arms are in, for their channels
  void look(const ActorInputs& inputs);
  void wear_face(const ActorInputs& inputs);

  const Figure* figure_;
  const Anatomy* anatomy_;
  unsigned seed_;
  std::array<float, 2> rest_depth_m_{};
  Home home_;
  Posture posture_ = Posture::standing;
  Place place_;
  std::deque<Stretch> stretches_;
  double stretch_start_s_ = 0;
  Place end_place_;
  Posture end_posture_ = Posture::standing;
  float swing_ = 0;
  float seatedness_ = 0;
  BodyControls controls_;
  SolvedBody solved_;
  SolvedBody trial_;
  std::array<ArmChannel, 2> channels_;  // in the pelvis' frame: a hand that changes its mind goes with the body
  std::array<ArmGoal, 2> shown_arms_;
  Follower<Eigen::Vector3f> head_gaze_;
  Follower<Eigen::Vector3f> eye_gaze_;
  std::map<std::string, Follower<float>> face_;
  bool looked_ = false;
  double start_s_ = -1;
  bool has_mouth_shape_ = false;
};

}  // namespace counterpart
