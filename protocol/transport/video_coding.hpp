// Pictures that build on earlier ones. This library only carries them, since making and reading them takes libavcodec;
// protocol/h264 does both.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "protocol/vocabulary/result.hpp"
#include "protocol/vocabulary/video.hpp"

namespace counterpart {

class VideoEncoder {
 public:
  virtual ~VideoEncoder() = default;

  struct Wish {
    bool afresh = false;              // build on no earlier picture
    std::int64_t bits_a_picture = 0;  // at most, over a quarter of a second at 25 a second; > 0
  };

  // The next picture of a sequence, raw_bgr8 before, h264 afterwards.
  [[nodiscard]] virtual Result<VideoFrame> encode(const VideoFrame& raw, const Wish& wish) = 0;
};

class VideoDecoder {
 public:
  virtual ~VideoDecoder() = default;

  // The next picture that came, h264 before, raw_bgr8 afterwards. Empty: it builds on one that did not come.
  [[nodiscard]] virtual Result<std::optional<VideoFrame>> decode(const VideoFrame& coded) = 0;
};

// Makers, one encoder for a link and one decoder for each of its peers. Either may be empty.
struct VideoCoding {
  std::function<std::unique_ptr<VideoEncoder>()> encoder;
  std::function<std::unique_ptr<VideoDecoder>()> decoder;
};

}  // namespace counterpart
