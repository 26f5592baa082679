// JSON that remembers on which line each value stood, so that a mistake in a scenario can be pointed at.
#pragma once

#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "protocol/vocabulary/result.hpp"

namespace counterpart::stage {

struct LocatedJson {
  nlohmann::json value;
  std::map<std::string, int> line_of;  // by JSON pointer, e.g. "/camera/eye"; counted from 1
};

[[nodiscard]] Result<LocatedJson> parse_located(const std::string& text);

}  // namespace counterpart::stage
