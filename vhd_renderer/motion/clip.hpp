// Keyframe clips in terms of what a body does (head, trunk, hands, face), not of one rig's joints, so that every figure
// can play every clip. The JSON form:
//   {"name": "nod", "seconds": 1.2, "tracks": {"head": [[0, 0,0,0], [0.2, 14,0,0], ...]}}
// Tracks, each a list of keys [time_s, values...]:
//   head, spine, pelvis   pitch (forward), roll (right), yaw (left), degrees, added to what the body does anyway
//   shrug                 left, right, 0..1
//   face.<shape>          weight of a face shape, 0..1
//   left_hand, right_hand x, y, z (right, forward, up; in arm lengths), then where fingers and palm point (3 + 3)
//   left_shape, right_shape    name of a hand shape
//   left_swivel, right_swivel  degrees by which the elbow is lifted
// "yields": true: it ends when the hands or the legs are told to do something.
// "frame": "chest" (between the shoulders; the default) or "head" (between the eyes), for the hands.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/motion/body_controls.hpp"

namespace counterpart {

template <class T>
using Keys = std::vector<std::pair<float, T>>;

struct HandKey {
  Eigen::Vector3f place{0, 0, 0};
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();  // of the hand frame W
};

struct Clip {
  std::string name;
  float seconds = 1;
  Keys<Turn> head, spine, pelvis;
  Keys<std::array<float, 2>> shrug;
  std::map<std::string, Keys<float>> face;
  std::array<Keys<HandKey>, 2> hand;
  std::array<Keys<HandShape>, 2> shape;
  std::array<Keys<float>, 2> swivel;
  bool sampled = false;  // keys lie close together, on a way that was recorded: it goes straight from one to the next
  bool in_head_frame = false;
  bool yields = false;  // done only while there is nothing to do: it ends when the hands or legs are needed

  unsigned parts() const;  // of the body that it moves (see part::)
};

Result<Clip> parse_clip(std::string_view json_text);

using ClipLibrary = std::map<std::string, Clip>;  // by name

// The clips made here.
const ClipLibrary& clip_library();

// The frame that hands are given in.
struct ClipFrame {
  Eigen::Vector3f origin_S{0, 0, 0};
  Eigen::Quaternionf R_S = Eigen::Quaternionf::Identity();  // x right, y forward, z up
  float arm_m = 0.5F;
};

// Somebody who does a thing twice does not do it the same way twice.
struct ClipVariation {
  bool mirrored = false;
  bool hands = true;               // false: without the hands
  Turn head;                       // added while the clip is at its height
  Eigen::Vector3f place{0, 0, 0};  // added to the hands' places, metres in the clip's frame
};

// What a clip adds at a time; `mask` leaves out parts that it must not touch.
void add_clip(const Clip& clip, float t_s, float weight, unsigned mask, BodyControls& controls,
              const ClipVariation& variation = {});

// The goal it has for a hand then; false if it has none.
bool clip_hand(const Clip& clip, float t_s, std::size_t side, const ClipFrame& frame, ArmGoal& goal,
               const ClipVariation& variation = {});

}  // namespace counterpart
