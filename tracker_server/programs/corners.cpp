#include "tracker_server/programs/corners.hpp"

#include <cmath>
#include <cstdlib>

namespace counterpart {

Result<std::array<double, 8>> corners_from(const std::string& text) {
  std::array<double, 8> corners{};
  const char* position = text.c_str();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    char* end = nullptr;
    corners[i] = std::strtod(position, &end);
    const bool last = i + 1 == corners.size();
    const bool separated = last ? *end == '\0' : *end == ',' || *end == ';' || *end == ' ';
    if (end == position || !separated || !std::isfinite(corners[i]))
      return failure(ErrorCode::invalid_argument,
                     "\"" + text + "\" is not four corners; write x0,y0,x1,y1,x2,y2,x3,y3 in pixels, any order.");
    position = end + 1;
  }
  return corners;
}

}  // namespace counterpart
