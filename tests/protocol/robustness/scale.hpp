// How much of it: the short form runs with every test, the long one when COUNTERPART_LONG is set (./test --long).
#pragma once

#include <cstdlib>

namespace counterpart {

inline int scaled(int in_short, int in_long) {
  return std::getenv("COUNTERPART_LONG") == nullptr ? in_short : in_long;
}

}  // namespace counterpart
