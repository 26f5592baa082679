// The offset between two monotonic clocks, with a bound: docs/protocol.md, section 4.
#pragma once

#include <cstdint>
#include <deque>

namespace counterpart {

struct ClockOffset {
  std::int64_t offset_ns = 0;       // peer's clock minus ours
  std::int64_t bound_ns = -1;       // the true offset is at most this far away; -1: nothing known
  std::int64_t round_trip_ns = -1;  // smallest of the samples
};

class ClockSync {
 public:
  // asked and back on our clock, received and answered on the peer's.
  void add(std::int64_t asked_ns, std::int64_t received_ns, std::int64_t answered_ns, std::int64_t back_ns);

  ClockOffset at(std::int64_t now_ns) const;

 private:
  struct Sample {
    std::int64_t lowest_ns = 0, highest_ns = 0;  // the offset lies between
    std::int64_t round_trip_ns = 0;
    std::int64_t taken_ns = 0;
  };
  std::deque<Sample> samples_;
};

}  // namespace counterpart
