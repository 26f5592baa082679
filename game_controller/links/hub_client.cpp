#include "game_controller/links/hub_client.hpp"

#include <chrono>
#include <utility>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double patience_with_stop_s = 2;

double waited_s(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// As much of the line as is legal.
std::vector<Move> read_line(const Position& root, const std::string& text) {
  std::vector<Move> line;
  Position at = root;
  std::size_t begin = 0;
  while ((begin = text.find_first_not_of(' ', begin)) != std::string::npos && line.size() < 100) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const auto move = read_move(international_rules, at, text.substr(begin, end - begin), MoveStyle::hub);
    if (!move) break;
    line.push_back(*move);
    at = after(international_rules, at, *move);
    begin = end;
  }
  return line;
}

}  // namespace

Result<HubClient> HubClient::start(const std::string& command, double patience_s) {
  auto child = Child::start(command);
  if (!child) return tl::make_unexpected(child.error());
  HubClient client(std::move(*child));
  client.name_ = command;
  for (const auto& [said, awaited] : {std::pair<std::string, std::string>{"hub", "wait"}, {"init", "ready"}}) {
    auto ok = client.say(said);
    if (ok) ok = client.wait_for(awaited, patience_s);
    if (!ok) {
      return failure(ok.error().code, "\"" + command + "\" does not answer as a Hub 2 engine: no \"" + awaited +
                                          "\" after \"" + said + "\". " + ok.error().message);
    }
  }
  return client;
}

Result<HubAnswer> HubClient::ask(const Position& position, double move_time_s, const std::function<bool()>& give_up) {
  std::string seconds = std::to_string(move_time_s);
  for (const std::string& line : {"pos pos=" + write_hub_position(international_rules, position),
                                  "level move-time=" + seconds, std::string("go think")}) {
    if (auto sent = say(line); !sent) return tl::make_unexpected(sent.error());
  }
  HubAnswer answer;
  const auto start = Clock::now();
  const double patience_s = 2 * move_time_s + 2;
  while (true) {
    const auto line = next_line(patience_s - waited_s(start), give_up);
    if (!line) {
      if (line.error().code == ErrorCode::refused) stop();
      return tl::make_unexpected(line.error());
    }
    if (line->command == "info") {
      if (const auto* score = line->find("score")) answer.score = hub_number(*score, -1e6, 1e6).value_or(answer.score);
      if (const auto* pv = line->find("pv")) answer.line = read_line(position, *pv);
    } else if (line->command == "error") {
      const auto* message = line->find("message");
      return failure(ErrorCode::bad_format, name_ + " says: " + (message != nullptr ? *message : "error"));
    } else if (line->command == "done") {
      const auto* text = line->find("move");
      const auto move = read_move(international_rules, position, text != nullptr ? *text : "", MoveStyle::hub);
      if (!move) return failure(ErrorCode::invalid_argument, name_ + " made an illegal move: " + move.error().message);
      answer.move = *move;
      if (answer.line.empty() || !(answer.line.front() == *move)) answer.line = {*move};
      return answer;
    }
  }
}

Result<HubLine> HubClient::next_line(double timeout_s, const std::function<bool()>& give_up) {
  const auto text = child_.channel().receive('\n', longest_hub_line, timeout_s, give_up);
  if (!text) return tl::make_unexpected(text.error());
  return read_hub_line(*text);
}

Result<void> HubClient::say(const std::string& line) {
  return child_.channel().send(line + "\n");
}

Result<void> HubClient::wait_for(const std::string& command, double patience_s) {
  const auto start = Clock::now();
  while (true) {
    const auto line = next_line(patience_s - waited_s(start));
    if (!line) return tl::make_unexpected(line.error());
    if (line->command == command) return {};
    if (const auto* name = line->find("name"); name != nullptr && line->command == "id") name_ = *name;
  }
}

// Its answer to the old question must not be taken for one to the next.
void HubClient::stop() {
  if (say("stop")) static_cast<void>(wait_for("done", patience_with_stop_s));
}

}  // namespace counterpart
