// Four points on a command line: "x0,y0,x1,y1,x2,y2,x3,y3".
#pragma once

#include <array>
#include <string>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

[[nodiscard]] Result<std::array<double, 8>> corners_from(const std::string& text);

}  // namespace counterpart
