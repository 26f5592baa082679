#include "protocol/transport/video_choice.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace counterpart {
namespace {

constexpr double kHeadroom = 2;     // of the bandwidth that raw pictures need
constexpr double kSmoothing = 0.1;  // share of the newest interval
constexpr std::int64_t kFirstDoubt = 10'000'000'000;
constexpr std::int64_t kLongestDoubt = 300'000'000'000;
constexpr std::int64_t kTakesEffect = 1'000'000'000;  // what was queued before a change is still on its way

// A step is about two thirds of the bytes of the one before.
constexpr std::array<VideoForm, 6> kForms{{{PixelCodec::raw_bgr8},
                                           {PixelCodec::jpeg, kJpegQuality},
                                           {PixelCodec::jpeg, 83},
                                           {PixelCodec::jpeg, 70},
                                           {PixelCodec::jpeg, 50},
                                           {PixelCodec::jpeg, 30}}};
constexpr std::size_t kGoodJpeg = 1;

}  // namespace

double VideoChoice::needed_bytes_per_second(std::size_t picture_bytes, std::int64_t now_ns) {
  const auto since_s = static_cast<double>(now_ns - std::exchange(last_ns_, now_ns)) / 1e9;
  const bool first = interval_s_ == 0;
  interval_s_ = first || since_s > 1 ? 1.0 / 25 : interval_s_ + kSmoothing * (since_s - interval_s_);
  return static_cast<double>(picture_bytes) / std::max(interval_s_, 1e-3);
}

void VideoChoice::do_with_less(std::int64_t now_ns) {
  step_ = std::min(step_ + 1, kForms.size() - 1);
  if (std::exchange(tried_more_, false)) doubt_ns_ = std::clamp(2 * doubt_ns_, kFirstDoubt, kLongestDoubt);
  not_more_before_ns_ = now_ns + doubt_ns_;
  not_less_before_ns_ = now_ns + kTakesEffect;
}

VideoForm VideoChoice::choose(std::size_t picture_bytes, const VideoLinks& links, std::int64_t now_ns) {
  if (links.all_local) return kForms.front();
  const double needed = needed_bytes_per_second(picture_bytes, now_ns);
  const bool dropped = std::exchange(dropped_, links.dropped) < links.dropped;
  if (dropped && now_ns >= not_less_before_ns_) {
    do_with_less(now_ns);
  } else if (now_ns >= not_more_before_ns_ && step_ > 0) {
    const bool carries_raw = links.slowest_bytes_per_second >= kHeadroom * needed;
    if (carries_raw || step_ > kGoodJpeg) {
      step_ = carries_raw ? 0 : step_ - 1;
      tried_more_ = true;
      not_more_before_ns_ = now_ns + doubt_ns_;
    }
  }
  return kForms[step_];
}

}  // namespace counterpart
