#include "tests/protocol/robustness/footprint.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <malloc.h>
#include <unistd.h>

namespace counterpart {

Footprint footprint() {
  ::malloc_trim(0);
  Footprint now;
  std::ifstream pages("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  pages >> total >> resident;
  now.resident_kib = resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) / 1024;
  const std::filesystem::directory_iterator all("/proc/self/fd");
  now.descriptors = static_cast<std::size_t>(std::distance(begin(all), end(all)));
  return now;
}

}  // namespace counterpart
