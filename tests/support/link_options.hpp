// What a test's end of a link says of itself.
#pragma once

#include "protocol/transport/endpoint.hpp"

namespace counterpart::testing_support {

inline LinkOptions options_of(Role role) {
  LinkOptions options;
  options.role = role;
  options.software = "test";
  return options;
}

}  // namespace counterpart::testing_support
