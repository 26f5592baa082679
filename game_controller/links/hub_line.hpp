// Lines of the Hub protocol, version 2: a command, then name=value, name="quoted value" or bare flags.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

constexpr std::size_t longest_hub_line = std::size_t{64} << 10;  // bytes; longer ones are refused

struct HubLine {
  std::string command;
  std::vector<std::pair<std::string, std::string>> arguments;  // a flag has an empty value

  // nullptr if there is none of that name.
  const std::string* find(std::string_view name) const;

  HubLine& with(std::string name, std::string value);
};

// An empty line has an empty command. Fails, with the column, for quotes that do not end and lines over 64 KiB.
[[nodiscard]] Result<HubLine> read_hub_line(std::string_view text);

// Quotes values that need it.
std::string write_hub_line(const HubLine& line);

// The whole text must be a number within the range.
std::optional<double> hub_number(const std::string& text, double lowest, double highest);

}  // namespace counterpart
