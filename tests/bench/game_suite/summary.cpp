#include "tests/bench/game_suite/summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace counterpart::bench {
namespace {

template <class Number>
double quantile(std::vector<Number>& values, double share) {
  if (values.empty()) return std::nan("");
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return static_cast<double>(*place);
}

template <class Number>
nlohmann::json spread(std::vector<Number> values) {
  return {{"median", quantile(values, 0.5)},
          {"p95", quantile(values, 0.95)},
          {"max", quantile(values, 1)},
          {"count", values.size()}};
}

template <class Number>
void append(std::vector<Number>& all, const std::vector<Number>& some) {
  all.insert(all.end(), some.begin(), some.end());
}

struct Line {
  const char* name;
  const char* pointer;  // into a summary
  const char* format;
};

constexpr Line lines[] = {
    {"games played", "/games", "%.0f"},
    {"games whose record equals the truth", "/equal", "%.0f"},
    {"moves of both sides", "/plies", "%.0f"},
    {"moves committed wrongly", "/wrong_commits", "%.0f"},
    {"illegal moves made", "/illegal_made", "%.0f"},
    {"  noticed, with the right code", "/illegal_right", "%.0f"},
    {"objections without cause", "/false_alarms", "%.0f"},
    {"captures asked about", "/asked", "%.0f"},
    {"hand away to move recognised, s: median", "/recognised_s/median", "%.2f"},
    {"  95 %", "/recognised_s/p95", "%.2f"},
    {"  longest", "/recognised_s/max", "%.2f"},
    {"reading all squares, ms: median", "/reading_ms/median", "%.3f"},
    {"  95 %", "/reading_ms/p95", "%.3f"},
    {"tracker's work on a frame, ms: median", "/observe_ms/median", "%.2f"},
    {"frames", "/frames", "%.0f"},
    {"CPU seconds a game", "/cpu_s_a_game", "%.1f"},
};

}  // namespace

nlohmann::json to_json(const Played& game) {
  return {{"name", game.name},
          {"plies", game.plies},
          {"frames", game.frames},
          {"equal", game.equal},
          {"trouble", game.trouble},
          {"wrong_commits", game.wrong_commits},
          {"illegal_made", game.illegal_made},
          {"illegal_right", game.illegal_right},
          {"false_alarms", game.false_alarms},
          {"asked", game.asked},
          {"recognised_s", game.recognised_s},
          {"reading_ms", game.reading_ms},
          {"observe_ms", game.observe_ms},
          {"cpu_s", game.cpu_s}};
}

Played played_from(const nlohmann::json& json) {
  Played game;
  json.at("name").get_to(game.name);
  json.at("plies").get_to(game.plies);
  json.at("frames").get_to(game.frames);
  json.at("equal").get_to(game.equal);
  json.at("trouble").get_to(game.trouble);
  json.at("wrong_commits").get_to(game.wrong_commits);
  json.at("illegal_made").get_to(game.illegal_made);
  json.at("illegal_right").get_to(game.illegal_right);
  json.at("false_alarms").get_to(game.false_alarms);
  json.at("asked").get_to(game.asked);
  json.at("recognised_s").get_to(game.recognised_s);
  json.at("reading_ms").get_to(game.reading_ms);
  json.at("observe_ms").get_to(game.observe_ms);
  json.at("cpu_s").get_to(game.cpu_s);
  return game;
}

nlohmann::json summary_of(const std::vector<Played>& games) {
  Played all;
  int equal = 0;
  nlohmann::json troubled = nlohmann::json::array();
  for (const Played& game : games) {
    equal += game.equal;
    all.plies += game.plies;
    all.frames += game.frames;
    all.wrong_commits += game.wrong_commits;
    all.illegal_made += game.illegal_made;
    all.illegal_right += game.illegal_right;
    all.false_alarms += game.false_alarms;
    all.asked += game.asked;
    all.cpu_s += game.cpu_s;
    append(all.recognised_s, game.recognised_s);
    append(all.reading_ms, game.reading_ms);
    append(all.observe_ms, game.observe_ms);
    if (!game.trouble.empty()) troubled.push_back({{"game", game.name}, {"equal", game.equal}, {"why", game.trouble}});
  }
  const double count = static_cast<double>(std::max<std::size_t>(games.size(), 1));
  return {{"games", games.size()},
          {"equal", equal},
          {"plies", all.plies},
          {"wrong_commits", all.wrong_commits},
          {"illegal_made", all.illegal_made},
          {"illegal_right", all.illegal_right},
          {"false_alarms", all.false_alarms},
          {"asked", all.asked},
          {"recognised_s", spread(all.recognised_s)},
          {"reading_ms", spread(all.reading_ms)},
          {"observe_ms", spread(all.observe_ms)},
          {"frames", all.frames},
          {"cpu_s_a_game", all.cpu_s / count},
          {"troubled", troubled}};
}

std::string table_of(const nlohmann::json& by_method) {
  char text[64];
  std::snprintf(text, sizeof text, "%-42s", "");
  std::string table = text;
  for (const auto& method : by_method.items()) {
    std::snprintf(text, sizeof text, "%16s", method.key().c_str());
    table += text;
  }
  for (const Line& line : lines) {
    std::snprintf(text, sizeof text, "\n%-42s", line.name);
    table += text;
    for (const auto& summary : by_method) {
      const auto& value = summary.at(nlohmann::json::json_pointer(line.pointer));
      char number[32];
      std::snprintf(number, sizeof number, line.format, value.is_number() ? value.get<double>() : std::nan(""));
      std::snprintf(text, sizeof text, "%16s", number);
      table += text;
    }
  }
  return table + "\n";
}

}  // namespace counterpart::bench
