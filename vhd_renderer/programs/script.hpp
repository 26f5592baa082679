// A script for `play`: JSON lines. A line is a command as on the wire (docs/protocol.md), with "at_ms", the time at
// which it is given; or {"scene": {...}} with "at_ms". Empty lines and lines that start with # are passed over.
#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <variant>
#include <vector>

#include "protocol/vocabulary/command.hpp"
#include "protocol/vocabulary/result.hpp"
#include "protocol/vocabulary/scene.hpp"

namespace counterpart {

struct ScriptLine {
  std::int64_t at_ms = 0;
  std::variant<Command, Scene> what;
};

// Sorted by time; lines of the same time stay in their order. Fails with the line's number.
Result<std::vector<ScriptLine>> read_script(std::istream& in, const std::string& name);

}  // namespace counterpart
