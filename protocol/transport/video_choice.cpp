#include "protocol/transport/video_choice.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace counterpart {
namespace {

constexpr double kHeadroom = 2;     // of the bandwidth that raw pictures need
constexpr double kFilled = 0.8;     // of what a link carries, at most by H.264
constexpr std::uint32_t kLate = 2;  // pictures that wait
constexpr int kLateInARow = 10;
constexpr double kSmoothing = 0.1;  // share of the newest interval
constexpr int kUsualPerSecond = 25;
constexpr double kUsualInterval = 1.0 / kUsualPerSecond;
constexpr std::int64_t kFirstDoubt = 10'000'000'000;
constexpr std::int64_t kLongestDoubt = 300'000'000'000;
constexpr std::int64_t kTakesEffect = 1'000'000'000;  // what was queued before a change is still on its way

// The best first. Of JPEG, a step is about two thirds of the bytes of the one before.
using Forms = VideoChoice::Forms;
constexpr std::array<VideoForm, 6> kWithoutH264{{{PixelCodec::raw_bgr8},
                                                 {PixelCodec::jpeg, kJpegQuality},
                                                 {PixelCodec::jpeg, 83},
                                                 {PixelCodec::jpeg, 70},
                                                 {PixelCodec::jpeg, 50},
                                                 {PixelCodec::jpeg, 30}}};

constexpr VideoForm h264(std::int64_t bits_per_second) {
  return {PixelCodec::h264, kJpegQuality, bits_per_second / kUsualPerSecond};
}

// A camera's pictures of 720x576 at 25 a second need 16 Mbit/s as JPEG of quality 83.
constexpr std::array<VideoForm, 8> kWithH264{{{PixelCodec::raw_bgr8},
                                              {PixelCodec::jpeg, kJpegQuality},
                                              {PixelCodec::jpeg, 83},
                                              h264(8'000'000),
                                              h264(4'000'000),
                                              h264(2'000'000),
                                              h264(1'000'000),
                                              h264(500'000)}};
constexpr std::size_t kJpegAt = 1, kH264At = 3;

Forms forms_of(std::optional<PixelCodec> wanted, bool takes_h264) {
  const Forms all = takes_h264 ? Forms(kWithH264) : Forms(kWithoutH264);
  if (!wanted) return all;
  if (*wanted == PixelCodec::raw_bgr8) return all.first(1);
  const bool can = *wanted == PixelCodec::h264 && takes_h264;
  return can ? all.subspan(kH264At) : all.subspan(kJpegAt, 1);
}

}  // namespace

void VideoChoice::note_interval(std::int64_t now_ns) {
  const auto since_s = static_cast<double>(now_ns - std::exchange(last_ns_, now_ns)) / 1e9;
  const bool first = interval_s_ == 0;
  interval_s_ = first || since_s > 1 ? kUsualInterval : interval_s_ + kSmoothing * (since_s - interval_s_);
  interval_s_ = std::max(interval_s_, 1e-3);
}

// A picture was dropped, or each of the last ones had to wait: what goes out all but fills the slowest link.
bool VideoChoice::is_too_much(const VideoLinks& links) {
  late_ = links.waiting >= kLate ? late_ + 1 : 0;
  return std::exchange(dropped_, links.dropped) < links.dropped || late_ >= kLateInARow;
}

// What was dropped filled the link, so what it delivered is what it carries.
void VideoChoice::do_with_less(Forms forms, double bytes_per_second, std::int64_t now_ns) {
  const auto is_still_too_much = [&](const VideoForm& form) {
    return static_cast<double>(form.bits_a_picture) / kUsualInterval > kFilled * 8 * bytes_per_second;
  };
  for (++step_; step_ + 1 < forms.size() && is_still_too_much(forms[step_]); ++step_) {
  }
  if (std::exchange(tried_more_, false)) doubt_ns_ = std::clamp(2 * doubt_ns_, kFirstDoubt, kLongestDoubt);
  not_more_before_ns_ = now_ns + doubt_ns_;
  not_less_before_ns_ = now_ns + kTakesEffect;
}

VideoForm VideoChoice::choose(std::size_t picture_bytes, const VideoLinks& links, std::int64_t now_ns) {
  const Forms forms = forms_of(wanted_, links.h264);
  if (links.all_local) return forms.front();
  note_interval(now_ns);
  const double raw_bytes_per_second = static_cast<double>(picture_bytes) / interval_s_;
  const bool carries_raw = links.slowest_bytes_per_second >= kHeadroom * raw_bytes_per_second;
  const bool has_raw = forms.front().codec == PixelCodec::raw_bgr8;
  const std::size_t best = has_raw && !carries_raw ? 1 : 0;
  if (is_too_much(links) && now_ns >= not_less_before_ns_) {
    do_with_less(forms, links.slowest_bytes_per_second, now_ns);
  } else if (now_ns >= not_more_before_ns_ && step_ > best) {
    step_ = has_raw && carries_raw ? 0 : step_ - 1;
    tried_more_ = true;
    not_more_before_ns_ = now_ns + doubt_ns_;
  }
  step_ = std::min(step_, forms.size() - 1);
  VideoForm form = forms[step_];
  form.bits_a_picture =
      static_cast<std::int64_t>(static_cast<double>(form.bits_a_picture) * interval_s_ / kUsualInterval);
  return form;
}

}  // namespace counterpart
