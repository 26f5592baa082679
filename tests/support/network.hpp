// Free ports on loopback for the programs that a test starts.
#pragma once

#include <string>

namespace counterpart::testing_support {

// "127.0.0.1:PORT" with a port that nobody listened on a moment ago.
std::string free_address();

}  // namespace counterpart::testing_support
