// H.264 on a link, by libavcodec. Its own library: who wants a link only, or the tracker only, needs no FFmpeg for it.
#pragma once

#include "protocol/transport/endpoint.hpp"

namespace counterpart {

// This end sends H.264 where the link is slow and the viewers take it (if this FFmpeg has an encoder: libx264), and
// takes it itself: what arrives is handed to the program raw.
void use_h264(LinkOptions& options);

// For tests and other carriers. The encoder is null if this FFmpeg has none.
[[nodiscard]] std::unique_ptr<VideoEncoder> make_h264_encoder();
[[nodiscard]] std::unique_ptr<VideoDecoder> make_h264_decoder();

}  // namespace counterpart
