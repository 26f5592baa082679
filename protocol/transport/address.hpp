// "HOST:PORT" as written on command lines; "[::1]:7401" for IPv6.
#pragma once

#include <cstdint>
#include <string>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct HostPort {
  std::string host;
  std::uint16_t port = 0;
};

[[nodiscard]] Result<HostPort> parse_address(const std::string& text);

std::string to_text(const HostPort& address);

}  // namespace counterpart
