// What this process holds: memory and open descriptors.
#pragma once

#include <cstddef>

namespace counterpart {

struct Footprint {
  std::size_t resident_kib = 0;
  std::size_t descriptors = 0;
};

Footprint footprint();

// Sanitizers keep freed memory back, so that memory says nothing under them.
constexpr bool memory_can_be_measured() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#else
  return true;
#endif
}

}  // namespace counterpart
