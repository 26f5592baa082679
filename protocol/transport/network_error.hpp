// What the system says of a socket → a sentence that says what to do.
#pragma once

#include <string>

#include <boost/system/error_code.hpp>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// Of the last system call of this thread.
boost::system::error_code last_system_error();

[[nodiscard]] Error network_error(const boost::system::error_code& error, const std::string& address);

}  // namespace counterpart
