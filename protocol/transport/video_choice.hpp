// Raw pictures or JPEG, by what the links to the viewers carry. Raw costs no time and no quality, but a picture of
// 720x576 at 25 a second is 31 MB/s.
#pragma once

#include <cstdint>

#include "protocol/vocabulary/video.hpp"

namespace counterpart {

// Of all links that pictures go out on.
struct VideoLinks {
  bool all_local = true;                // to this host
  double slowest_bytes_per_second = 0;  // what the slowest has been seen to carry; it may carry more
  std::uint64_t dropped = 0;            // pictures so far that newer ones pushed out
};

class VideoChoice {
 public:
  // For the next raw picture, of so many bytes.
  PixelCodec choose(std::size_t picture_bytes, const VideoLinks& links, std::int64_t now_ns);

 private:
  PixelCodec codec_ = PixelCodec::jpeg;
  double interval_s_ = 0;  // from picture to picture, smoothed; 0: not known
  std::int64_t last_ns_ = 0;
  std::uint64_t dropped_ = 0;
  std::int64_t doubt_ns_ = 0;  // between leaving raw and trying it again; longer each time
  std::int64_t not_raw_before_ns_ = 0;
};

}  // namespace counterpart
