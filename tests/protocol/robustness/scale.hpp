// How much of it: the short form runs with every test, the long one when COUNTERPART_LONG is set (./test --long).
#pragma once

#include <cstdlib>

namespace counterpart {

template <typename Value>
Value scaled(Value in_short, Value in_long) {
  return std::getenv("COUNTERPART_LONG") == nullptr ? in_short : in_long;
}

}  // namespace counterpart
