// Raw pictures, good JPEG, H.264 or smaller JPEG, by what the links to the viewers carry. Raw costs no time and no
// quality, but a picture of 720x576 at 25 a second is 31 MB/s.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "protocol/transport/jpeg.hpp"
#include "protocol/vocabulary/video.hpp"

namespace counterpart {

// Of all links that pictures go out on.
struct VideoLinks {
  bool all_local = true;                // to this host
  double slowest_bytes_per_second = 0;  // what the slowest has been seen to carry; it may carry more
  std::uint64_t dropped = 0;            // pictures so far that newer ones pushed out
  std::uint32_t waiting = 0;            // pictures to go out on the link that has the most of them
  bool h264 = false;                    // all viewers take it, and there is an encoder
};

// What a raw picture is turned into.
struct VideoForm {
  PixelCodec codec = PixelCodec::raw_bgr8;
  int quality = kJpegQuality;       // of a JPEG
  std::int64_t bits_a_picture = 0;  // of H.264, at most and over a quarter of a second
};

class VideoChoice {
 public:
  using Forms = std::span<const VideoForm>;  // the best first

  // wanted: this codec and no other. H.264 is JPEG, though, while not all viewers take it.
  explicit VideoChoice(std::optional<PixelCodec> wanted = std::nullopt) : wanted_(wanted) {}

  // For the next raw picture, of so many bytes.
  VideoForm choose(std::size_t picture_bytes, const VideoLinks& links, std::int64_t now_ns);

 private:
  void note_interval(std::int64_t now_ns);
  bool is_too_much(const VideoLinks& links);
  void do_with_less(Forms forms, double bytes_per_second, std::int64_t now_ns);

  std::optional<PixelCodec> wanted_;
  std::size_t step_ = 1;   // in the list of forms, the best one first
  double interval_s_ = 0;  // from picture to picture, smoothed; 0: not known
  std::int64_t last_ns_ = 0;
  std::uint64_t dropped_ = 0;
  int late_ = 0;               // pictures in a row that found others waiting
  bool tried_more_ = true;     // since it last had to do with less
  std::int64_t doubt_ns_ = 0;  // before more is tried; longer each time that it was too much
  std::int64_t not_more_before_ns_ = 0, not_less_before_ns_ = 0;
};

}  // namespace counterpart
