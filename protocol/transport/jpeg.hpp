// Pictures on the wire, raw or compressed.
#pragma once

#include "protocol/vocabulary/result.hpp"
#include "protocol/vocabulary/video.hpp"

namespace counterpart {

constexpr int kJpegQuality = 92;  // 4:2:0; 100-170 kB at 720x576

// The same picture in this codec, raw_bgr8 or jpeg; a picture that is already in it is copied. quality: of a JPEG, 1 to
// 100.
[[nodiscard]] Result<VideoFrame> convert(const VideoFrame& frame, PixelCodec codec, int quality = kJpegQuality);

}  // namespace counterpart
