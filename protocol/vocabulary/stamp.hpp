// The name and time of a frame, carried by everything that was made from it.
#pragma once

#include <cstdint>

namespace counterpart {

using FrameId = std::uint64_t;

struct FrameStamp {
  FrameId frame_id = 0;         // counts from 0 at the camera, never reused within a run
  std::int64_t capture_ns = 0;  // middle of the exposure, nanoseconds on the camera host's monotonic clock

  friend bool operator==(const FrameStamp&, const FrameStamp&) = default;
};

}  // namespace counterpart
