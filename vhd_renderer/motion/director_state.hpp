// What the director remembers between frames.
#pragma once

#include <array>
#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vhd_renderer/motion/actor.hpp"
#include "vhd_renderer/motion/command_queue.hpp"
#include "vhd_renderer/motion/director.hpp"
#include "vhd_renderer/motion/grasp_motion.hpp"
#include "vhd_renderer/motion/walk_round.hpp"

namespace counterpart {

struct PieceOnStage {
  ScenePiece piece;
  Eigen::Vector3f foot_S{0, 0, 0};
  float turn_rad = 0;  // about its own axis: it turns with the hand that carried it
};

struct RunningGrasp {
  std::uint64_t id = 0;      // 0: nobody's any more; the arm is only finishing
  std::uint64_t source = 0;  // for the arm's channel
  std::string piece;
  GraspMotion motion;
  double start_s = 0;
  GraspPhase reported = GraspPhase::done;
  bool holds = false;
  bool settled = false;       // the piece has been put down
  float turn_offset_rad = 0;  // of the piece against the hand
  double gap_mm = -1;
};

struct RunningClip {
  std::uint64_t id = 0;
  std::uint64_t source = 0;
  const Clip* clip = nullptr;
  Keyframe how;
  unsigned mask = 0;
  double start_s = 0;
  double fade_from_s = -1;  // >= 0: it was stopped and dies away
  ClipVariation variation;
};

struct RunningGaze {
  std::uint64_t id = 0;
  Gaze gaze;
  double start_s = 0;
};

struct RunningFace {
  std::uint64_t id = 0;
  Express express;
  double start_s = 0;
};

// Told to say something, the mouth waits for its sound; the words are shown at once.
struct RunningSpeech {
  std::uint64_t id = 0;
  Say say;
  SoundToCome to_come;
  double told_s = 0;
  std::optional<Utterance> utterance;  // nothing: there is nothing to hear yet
  std::shared_ptr<const Sound> sound;
  double start_s = 0;  // of the utterance
};

struct Director::State {
  const Figure* figure = nullptr;
  Anatomy anatomy;
  bool has_body = false;
  std::optional<Actor> actor;
  std::vector<std::string> morph_names;
  CommandQueue queue;
  Speaker speaker;
  ClipLibrary library;

  Scene scene;
  bool dark = false;  // B is S turned by half a circle
  std::vector<PieceOnStage> pieces;
  GripSource grip_source;
  std::array<Grip, 2> grips;
  GripTarget gripped;  // what the grips were made for
  bool grips_fit = false;

  std::array<std::optional<RunningGrasp>, 2> grasps;
  std::list<RunningClip> clips;
  std::optional<RunningGaze> gaze;
  std::optional<RunningFace> face;
  std::optional<RunningSpeech> speech;
  std::uint64_t navigating = 0;  // command; 0: none
  std::string going_phase;
  std::uint64_t sources = 16;
  unsigned variations = 0;

  std::int64_t now_ns = 0;
  double now_s = 0;
  float dt_s = 0.04F;
  bool started = false;
  Eigen::Vector3f camera_S{0, 1, 0.5F};
  Eigen::Vector3f player_S{0, 0.8F, 0.4F};

  // Between B and S; the same map both ways.
  Eigen::Vector3f turned(const Eigen::Vector3f& p) const { return dark ? Eigen::Vector3f(-p.x(), -p.y(), p.z()) : p; }
  Eigen::Vector3f S_from_B(const Point3& p) const {
    return turned({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  }

  PieceOnStage* find_piece(const std::string& name);
  void set_scene(const Scene& next);
  unsigned held_parts() const;

  // Commands: what each needs, whether it can be, its start and its untimely end.
  Needs needs_of(const Command& command) const;
  std::string why_not(const Command& command) const;  // a code; empty: fine
  void submit(const Command& command);
  void start(CommandQueue::Entry& entry, unsigned free_parts);
  std::pair<GraspTask, float> with_best_hand(const std::vector<std::size_t>& hands, const GraspTask& task,
                                             const std::string& moved);
  float clear_heading(std::size_t side, const Eigen::Vector3f& foot_S, const std::string& moved);
  void set_headings(GraspTask& task, const std::string& moved);
  void end_idle_clips();
  ClipVariation next_variation();
  void start_grasp(CommandQueue::Entry& entry, const Grasp& grasp, unsigned free_parts);
  std::vector<Footprint> obstacles() const;
  std::optional<std::vector<Eigen::Vector2f>> way_through(const Eigen::Vector2f& from,
                                                          const std::vector<Eigen::Vector2f>& through,
                                                          const Eigen::Vector2f& to) const;
  void start_navigation(std::uint64_t id, const Navigate& navigate);
  void cancel_body(std::uint64_t id);  // the body lets go of what the command did
  void cancel(std::uint64_t id);       // and says so
  void stop(const Stop& stop, std::uint64_t own_id);

  // A frame.
  void advance_grasp(std::size_t side, ActorInputs& inputs);
  void advance_clips(BodyControls& controls, ActorInputs& inputs);
  void advance_speech(ActorInputs& inputs);
  void advance_rest(ActorInputs& inputs);
  void measure_grasps();
  Eigen::Isometry3f hand_S(std::size_t side) const;
  void carry_piece(RunningGrasp& grasp, std::size_t side);
  Eigen::Vector3f gaze_target(const Gaze& gaze) const;
  Performance performance() const;
};

// Weights of face shapes for an expression; empty: unknown.
const std::map<std::string, float>* face_of(const std::string& expression);

}  // namespace counterpart
