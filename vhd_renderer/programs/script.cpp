#include "vhd_renderer/programs/script.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "protocol/codec/json.hpp"

namespace counterpart {
namespace {

using nlohmann::json;

Result<ScriptLine> read_line(json value) {
  ScriptLine line;
  if (value.contains("at_ms")) {
    if (!value["at_ms"].is_number_integer() || value["at_ms"].get<std::int64_t>() < 0) {
      return failure(ErrorCode::bad_format, "\"at_ms\" has to be a whole number from 0");
    }
    line.at_ms = value["at_ms"].get<std::int64_t>();
    value.erase("at_ms");
  }
  if (value.contains("scene")) {
    auto scene = from_json<Scene>(value["scene"]);
    if (!scene) return tl::make_unexpected(scene.error());
    line.what = std::move(*scene);
    return line;
  }
  auto command = from_json<Command>(value);
  if (!command) return tl::make_unexpected(command.error());
  line.what = std::move(*command);
  return line;
}

}  // namespace

Result<std::vector<ScriptLine>> read_script(std::istream& in, const std::string& name) {
  std::vector<ScriptLine> lines;
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos || text[first] == '#') continue;
    json value = json::parse(text, nullptr, false);
    const std::string where = name + ", line " + std::to_string(number) + ": ";
    if (!value.is_object()) return failure(ErrorCode::bad_format, where + "this is not a JSON object");
    auto line = read_line(std::move(value));
    if (!line) return failure(line.error().code, where + line.error().message);
    lines.push_back(std::move(*line));
  }
  std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.at_ms < b.at_ms; });
  return lines;
}

}  // namespace counterpart
