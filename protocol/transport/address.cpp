#include "protocol/transport/address.hpp"

#include <charconv>

namespace counterpart {

Result<HostPort> parse_address(const std::string& text) {
  const auto bad = [&] {
    return failure(ErrorCode::invalid_argument,
                   "\"" + text + "\" is not an address; write HOST:PORT, for example 127.0.0.1:7401");
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return bad();
  HostPort address;
  address.host = text.substr(0, colon);
  if (address.host.front() == '[' && address.host.back() == ']') {
    address.host = address.host.substr(1, address.host.size() - 2);
  } else if (address.host.find(':') != std::string::npos) {
    return bad();
  }
  const char* first = text.data() + colon + 1;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, address.port);
  if (error != std::errc{} || end != last || address.host.empty()) return bad();
  return address;
}

std::string to_text(const HostPort& address) {
  const bool v6 = address.host.find(':') != std::string::npos;
  return (v6 ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

}  // namespace counterpart
