// How much of something may come in a second, with a reserve for bursts (generic cell rate algorithm).
#pragma once

#include <algorithm>
#include <cstdint>

namespace counterpart {

class RateLimit {
 public:
  // A reserve of `burst` at the start and after a pause.
  RateLimit(std::int64_t per_second, std::int64_t burst)
      : interval_ns_(1'000'000'000 / per_second), reserve_ns_(burst * interval_ns_) {}

  // One more came. Until when no more should be taken; not after now_ns: go on.
  std::int64_t count(std::int64_t now_ns) {
    used_until_ns_ = std::max(used_until_ns_, now_ns) + interval_ns_;
    return used_until_ns_ - reserve_ns_;
  }

 private:
  std::int64_t interval_ns_, reserve_ns_;
  std::int64_t used_until_ns_ = 0;
};

}  // namespace counterpart
