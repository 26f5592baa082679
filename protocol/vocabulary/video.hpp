// A picture on the wire.
#pragma once

#include <cstdint>
#include <vector>

#include "protocol/vocabulary/stamp.hpp"

namespace counterpart {

enum class PixelCodec : std::uint16_t {
  raw_bgr8 = 1,  // rows of width * 3 bytes, `stride` bytes apart
  jpeg = 2,      // stride is 0
  h264 = 3,      // Annex B, 4:2:0, BT.601; stride: how many frame_ids back the picture lies that it builds on; 0: on none
};

constexpr std::uint32_t kMostPixels = 1U << 25;  // a small message must not become gigabytes when it is read

struct VideoFrame {
  FrameStamp stamp;
  PixelCodec codec = PixelCodec::raw_bgr8;
  std::uint16_t width = 0;
  std::uint16_t height = 0;
  std::uint32_t stride = 0;
  std::vector<std::uint8_t> bytes;

  friend bool operator==(const VideoFrame&, const VideoFrame&) = default;
};

// What covers the board in one picture; the composite puts it in front of everything virtual.
struct Mask {
  FrameStamp stamp;
  std::uint16_t width = 0;
  std::uint16_t height = 0;
  // Run lengths over the picture by rows, alternating, starting with "not covered"; they sum to width * height.
  std::vector<std::uint32_t> runs;

  friend bool operator==(const Mask&, const Mask&) = default;
};

}  // namespace counterpart
