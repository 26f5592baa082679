#include "vhd_renderer/pipeline/pairing.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace counterpart {
namespace {

// Pictures whose pose is still on its way: in real time more would be delay. In lockstep one is in work at a time; the
// bound only stops a peer that never pairs.
constexpr std::size_t kPicturesNewest = 3;
constexpr std::size_t kWaitingEvery = 256;

// Poses go ahead of their pictures on a slow link: two and a half seconds at 25 a second.
constexpr std::size_t kWaitingNewest = 64;

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
  const bool newest = policy_ == PairingPolicy::newest;
  auto pictures = static_cast<std::size_t>(std::count_if(waiting_.begin(), waiting_.end(), has_picture));
  while (waiting_.size() > (newest ? kWaitingNewest : kWaitingEvery) || (newest && pictures > kPicturesNewest)) {
    const bool picture = has_picture(*waiting_.begin());
    pictures -= picture ? 1 : 0;
    dropped_ += picture ? 1 : 0;
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
  dropped_ += static_cast<std::uint64_t>(std::count_if(waiting_.begin(), found, has_picture));
  waiting_.erase(waiting_.begin(), std::next(found));
  return pair;
}

void Pairing::restart() {
  waiting_.clear();
  taken_.reset();
}

}  // namespace counterpart
