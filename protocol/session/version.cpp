#include "protocol/session/version.hpp"

#include <algorithm>

namespace counterpart {
namespace {

std::string range(int least, int most) {
  if (least == most) return "version " + std::to_string(least);
  return "versions " + std::to_string(least) + "-" + std::to_string(most);
}

}  // namespace

Result<std::uint8_t> agree_on_version(std::uint8_t peer_min, std::uint8_t peer_max) {
  const std::uint8_t highest = std::min(peer_max, kVersionMax);
  if (highest >= std::max(peer_min, kVersionMin)) return highest;
  return failure(ErrorCode::version_mismatch, "the peer speaks " + range(peer_min, peer_max) +
                                                  ", this program speaks " + range(kVersionMin, kVersionMax) +
                                                  "; update the older of the two");
}

}  // namespace counterpart
