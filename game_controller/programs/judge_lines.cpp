#include "game_controller/programs/judge_lines.hpp"

#include <istream>
#include <ostream>
#include <vector>

#include <nlohmann/json.hpp>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/referee/judge.hpp"
#include "game_controller/referee/sentences.hpp"

namespace counterpart {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t longest_line = std::size_t{64} << 10;

Json error(const std::string& message) {
  Json out;
  out["verdict"] = "error";
  out["message"] = message;
  return out;
}

Json answer(const Rules& rules, const Position& before, const Verdict& verdict) {
  Json out;
  out["verdict"] = verdict.move ? "legal" : "illegal";
  if (verdict.move) {
    out["move"] = hub_text(rules, *verdict.move);
    return out;
  }
  const auto legal = legal_moves_text(rules, before);
  out["reason"] = verdict.reason;
  out["squares"] = verdict.squares;
  out["say"] = sentence(verdict.reason, verdict.squares, legal);
  out["legal"] = legal;
  return out;
}

Json judged(const Rules& rules, const std::string& line) {
  if (line.size() > longest_line) return error("The line is longer than 64 KiB.");
  try {
    const Json in = Json::parse(line);
    const auto before = read_fen(rules, in.at("before").get<std::string>());
    if (!before) return error(before.error().message);
    const auto seen = read_squares(rules, in.at("after").get<std::string>(), before->turn);
    if (!seen) return error("\"after\": " + seen.error().message);
    std::vector<Cell> strays;
    if (in.contains("light")) {
      for (const Json& stray : in.at("light")) strays.push_back({stray.at(0).get<int>(), stray.at(1).get<int>()});
    }
    return answer(rules, *before, judge(rules, *before, *seen, strays));
  } catch (const nlohmann::json::exception& e) {
    return error(std::string("Expected {\"before\": FEN, \"after\": squares, \"light\": [[row, column, piece]]}: ") +
                 e.what());
  }
}

}  // namespace

std::string judge_line(const Rules& rules, const std::string& line) {
  return judged(rules, line).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool judge_lines(const Rules& rules, std::istream& in, std::ostream& out) {
  bool all_read = true;
  std::string line;
  while (std::getline(in, line)) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string verdict = judge_line(rules, line);
    all_read = all_read && verdict.find("\"verdict\":\"error\"") == std::string::npos;
    out << verdict << std::endl;
  }
  return all_read;
}

}  // namespace counterpart
