#include "protocol/transport/video_choice.hpp"

#include <algorithm>
#include <utility>

namespace counterpart {
namespace {

constexpr double kHeadroom = 2;     // of the bandwidth that raw pictures need
constexpr double kSmoothing = 0.1;  // share of the newest interval
constexpr std::int64_t kFirstDoubt = 10'000'000'000;
constexpr std::int64_t kLongestDoubt = 300'000'000'000;

}  // namespace

PixelCodec VideoChoice::choose(std::size_t picture_bytes, const VideoLinks& links, std::int64_t now_ns) {
  if (links.all_local) return PixelCodec::raw_bgr8;
  const auto since_s = static_cast<double>(now_ns - std::exchange(last_ns_, now_ns)) / 1e9;
  const bool first = interval_s_ == 0;
  interval_s_ = first || since_s > 1 ? 1.0 / 25 : interval_s_ + kSmoothing * (since_s - interval_s_);
  const bool dropped = std::exchange(dropped_, links.dropped) < links.dropped;
  if (codec_ == PixelCodec::raw_bgr8 && dropped) {
    codec_ = PixelCodec::jpeg;
    doubt_ns_ = std::clamp(2 * doubt_ns_, kFirstDoubt, kLongestDoubt);
    not_raw_before_ns_ = now_ns + doubt_ns_;
  }
  const double needed = static_cast<double>(picture_bytes) / std::max(interval_s_, 1e-3);
  const bool carries_raw = links.slowest_bytes_per_second >= kHeadroom * needed;
  if (carries_raw && now_ns >= not_raw_before_ns_) codec_ = PixelCodec::raw_bgr8;
  return codec_;
}

}  // namespace counterpart
