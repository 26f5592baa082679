// Which versions of the protocol this program speaks, and which one two programs agree on.
#pragma once

#include <cstdint>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

constexpr std::uint8_t kVersionMin = 1;
constexpr std::uint8_t kVersionMax = 1;

// The highest version that both sides speak.
[[nodiscard]] Result<std::uint8_t> agree_on_version(std::uint8_t peer_min, std::uint8_t peer_max);

}  // namespace counterpart
