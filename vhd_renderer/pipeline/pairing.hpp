// Frame N with pose N, never with another: the paper's key issue, synchronising synthetic scenes with the real camera
// (section 4), solved by the frame's name instead of by equal delays.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "protocol/vocabulary/pose.hpp"
#include "protocol/vocabulary/video.hpp"

namespace counterpart {

struct PairedFrame {
  VideoFrame video;
  PoseEstimate pose;
  std::optional<Mask> mask;
};

enum class PairingPolicy : std::uint8_t {
  newest = 1,  // the newest complete pair; older ones and those that never become complete are dropped and counted
  every = 2,   // lockstep: each pair in order, nothing dropped
};

class Pairing {
 public:
  explicit Pairing(PairingPolicy policy) : policy_(policy) {}

  void add(VideoFrame video);
  void add(const PoseEstimate& pose);
  void add(Mask mask);

  // The next pair to composite; empty while there is none.
  std::optional<PairedFrame> take();

  // Another source of frames: their numbers start anew, what waits is forgotten.
  void restart();

  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Half {
    std::optional<VideoFrame> video;
    std::optional<PoseEstimate> pose;
    std::optional<Mask> mask;
    bool complete() const { return video.has_value() && pose.has_value(); }
  };

  static bool has_picture(const std::pair<const FrameId, Half>& entry) { return entry.second.video.has_value(); }

  Half* half(FrameId frame);
  void bound();

  PairingPolicy policy_;
  std::map<FrameId, Half> waiting_;
  std::optional<FrameId> taken_;
  std::uint64_t dropped_ = 0;
};

}  // namespace counterpart
