// What the virtual human can be told, and what it answers.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "protocol/vocabulary/pose.hpp"

namespace counterpart {

enum class Hand : std::uint8_t { any = 1, left = 2, right = 3 };

enum class BodyPart : std::uint8_t { whole = 1, upper = 2, head = 3, left_arm = 4, right_arm = 5, face = 6, legs = 7 };

// Reach, close the hand, carry, let go (the paper's three subtasks; section 4).
struct Grasp {
  std::string piece;  // a piece of the scene, e.g. "light_31"; empty: only touch the last point of the path
  std::vector<Point3>
      path_B;  // where the foot of the piece goes: hops in order, the last is where it stays; z = 0 is the board
  Hand hand = Hand::any;
  std::string style;      // "" (as a player does), "slam", "hesitant"; without a piece "point": hold there for a second
  double duration_s = 0;  // 0: as long as a person would take

  friend bool operator==(const Grasp&, const Grasp&) = default;
};

struct Keyframe {
  std::string clip;                 // "nod", "head_shake", ...
  double speed = 1;                 // > 0
  double weight = 1;                // 0..1
  BodyPart part = BodyPart::whole;  // whole: the parts the clip names itself
  bool loop = false;                // until stopped

  friend bool operator==(const Keyframe&, const Keyframe&) = default;
};

struct Navigate {
  std::string place;           // "entrance", "chair", "seat" (walk to the chair and sit), "away"; empty: the path
  std::vector<Point3> path_B;  // floor points, z ignored
  double heading_rad = 0;      // at the end of a path: angle of the facing direction from B's x axis, towards y
  std::string gait = "walk";   // "walk", "hurry", "instant": be there at once

  friend bool operator==(const Navigate&, const Navigate&) = default;
};

enum class GazeTarget : std::uint8_t { square = 1, piece = 2, player = 3, camera = 4, point = 5, ahead = 6 };

struct Gaze {
  GazeTarget target = GazeTarget::ahead;
  int square = 0;
  std::string piece;
  Point3 point_B{};
  double hold_s = 0;  // 0: until the next gaze

  friend bool operator==(const Gaze&, const Gaze&) = default;
};

struct Say {
  std::string text;  // what is spoken and subtitled
  std::string language = "en";
  std::string code;  // what is meant ("must_capture"), for mirrors in other languages

  friend bool operator==(const Say&, const Say&) = default;
};

struct Express {
  std::string face;   // "neutral", "smile", "frown", "surprise", "doubt", "sad"
  double weight = 1;  // 0..1
  double hold_s = 0;  // 0: until the next express

  friend bool operator==(const Express&, const Express&) = default;
};

struct Stop {
  std::vector<std::uint64_t> commands;  // empty: everything that runs or waits

  friend bool operator==(const Stop&, const Stop&) = default;
};

using Action = std::variant<Grasp, Keyframe, Navigate, Gaze, Say, Express, Stop>;

struct Command {
  std::uint64_t id = 0;  // unique for its sender; a second one with the same id is answered, not done again
  Action action = Stop{};
  std::vector<std::uint64_t> after;  // wait until these have ended, however they ended
  std::int64_t delay_ms = 0;         // and then this long
  std::int64_t deadline_ms = 0;      // fail if not finished so long after being accepted; 0: none
  bool interrupt = false;            // cancel what holds the same body parts, instead of queueing behind it

  friend bool operator==(const Command&, const Command&) = default;
};

enum class FeedbackState : std::uint8_t {
  accepted = 1,
  started = 2,
  progress = 3,
  finished = 4,
  failed = 5,
  cancelled = 6
};

constexpr bool is_final(FeedbackState state) {
  return state == FeedbackState::finished || state == FeedbackState::failed || state == FeedbackState::cancelled;
}

struct Feedback {
  std::uint64_t command_id = 0;
  FeedbackState state = FeedbackState::accepted;
  std::string verb;   // "grasp", ...
  std::string phase;  // with progress: "reach", "close", "carry", "release", "walk", "sit" ...
  std::string code;   // why it failed: "unknown_clip", "unknown_piece", "out_of_reach", "not_a_number", "deadline", ...
  double gap_mm = -1;         // distance left between the grasp point and its target; -1: does not apply
  std::int64_t stamp_ns = 0;  // capture time of the frame in which it happened

  friend bool operator==(const Feedback&, const Feedback&) = default;
};

}  // namespace counterpart
