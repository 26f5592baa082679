// The clock of this host that every stamp of the transport is read from.
#pragma once

#include <chrono>
#include <cstdint>

namespace counterpart {

inline std::int64_t monotonic_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace counterpart
