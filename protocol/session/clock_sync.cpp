#include "protocol/session/clock_sync.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace counterpart {
namespace {

constexpr std::size_t kSamples = 64;
constexpr std::int64_t kDriftDivisor = 20'000;  // two crystals may drift apart by 50 millionths

}  // namespace

void ClockSync::add(std::int64_t asked_ns, std::int64_t received_ns, std::int64_t answered_ns, std::int64_t back_ns) {
  const std::int64_t round_trip_ns = (back_ns - asked_ns) - (answered_ns - received_ns);
  if (back_ns < asked_ns || answered_ns < received_ns || round_trip_ns < 0) return;
  samples_.push_back({answered_ns - back_ns, received_ns - asked_ns, round_trip_ns, back_ns});
  if (samples_.size() > kSamples) samples_.pop_front();
}

ClockOffset ClockSync::at(std::int64_t now_ns) const {
  if (samples_.empty()) return {};
  std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
  std::int64_t highest = std::numeric_limits<std::int64_t>::max();
  std::vector<Sample> quickest(samples_.begin(), samples_.end());
  for (const Sample& sample : samples_) {
    const std::int64_t drift = std::max<std::int64_t>(0, now_ns - sample.taken_ns) / kDriftDivisor + 1;
    lowest = std::max(lowest, sample.lowest_ns - drift);
    highest = std::min(highest, sample.highest_ns + drift);
  }
  std::sort(quickest.begin(), quickest.end(),
            [](const Sample& a, const Sample& b) { return a.round_trip_ns < b.round_trip_ns; });
  ClockOffset result;
  result.round_trip_ns = quickest.front().round_trip_ns;
  std::vector<std::int64_t> middles;
  for (std::size_t i = 0; i < (quickest.size() + 3) / 4; ++i) {
    middles.push_back(quickest[i].lowest_ns + (quickest[i].highest_ns - quickest[i].lowest_ns) / 2);
  }
  std::nth_element(middles.begin(), middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2), middles.end());
  if (lowest > highest) std::swap(lowest, highest);  // a clock jumped: the samples contradict each other
  result.offset_ns = std::clamp(middles[middles.size() / 2], lowest, highest);
  result.bound_ns = std::max(result.offset_ns - lowest, highest - result.offset_ns);
  return result;
}

}  // namespace counterpart
