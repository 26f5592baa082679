#include "vhd_renderer/pipeline/pairing.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace counterpart {
namespace {

// Frames whose other half is still on its way. Two in real time: more is delay. In lockstep one is in work at a time;
// the bound only stops a peer that never pairs.
constexpr std::size_t kWaitingNewest = 3;
constexpr std::size_t kWaitingEvery = 256;

}  // namespace

// Null for frames that are too old to matter.
Pairing::Half* Pairing::half(FrameId frame) {
  if (taken_ && frame <= *taken_) return nullptr;
  return &waiting_[frame];
}

void Pairing::add(VideoFrame video) {
  if (Half* h = half(video.stamp.frame_id)) h->video = std::move(video);
  bound();
}

void Pairing::add(const PoseEstimate& pose) {
  if (Half* h = half(pose.stamp.frame_id)) h->pose = pose;
  bound();
}

void Pairing::add(Mask mask) {
  if (Half* h = half(mask.stamp.frame_id)) h->mask = std::move(mask);
  bound();
}

void Pairing::bound() {
  const std::size_t most = policy_ == PairingPolicy::newest ? kWaitingNewest : kWaitingEvery;
  while (waiting_.size() > most) {
    dropped_ += waiting_.begin()->second.video ? 1 : 0;
    waiting_.erase(waiting_.begin());
  }
}

std::optional<PairedFrame> Pairing::take() {
  const auto is_complete = [](const auto& entry) { return entry.second.complete(); };
  auto found = waiting_.end();
  if (policy_ == PairingPolicy::every) {
    found = std::find_if(waiting_.begin(), waiting_.end(), is_complete);
  } else {
    const auto newest = std::find_if(waiting_.rbegin(), waiting_.rend(), is_complete);
    if (newest != waiting_.rend()) found = std::prev(newest.base());
  }
  if (found == waiting_.end()) return std::nullopt;
  PairedFrame pair{std::move(*found->second.video), *found->second.pose, std::move(found->second.mask)};
  taken_ = found->first;
  dropped_ += static_cast<std::uint64_t>(
      std::count_if(waiting_.begin(), found, [](const auto& entry) { return entry.second.video.has_value(); }));
  waiting_.erase(waiting_.begin(), std::next(found));
  return pair;
}

void Pairing::restart() {
  waiting_.clear();
  taken_.reset();
}

}  // namespace counterpart
