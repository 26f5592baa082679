#include <algorithm>
#include <deque>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <thread>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "protocol/codec/json.hpp"
#include "protocol/codec/names.hpp"
#include "protocol/daemon/stop_signal.hpp"
#include "protocol/transport/monotonic_clock.hpp"
#include "protocol/vhp/commands.hpp"
#include "protocol/vhp/common.hpp"
#include "protocol/vhp/script.hpp"

namespace counterpart::vhp {
namespace {

struct ScriptArguments {
  std::string file;
  std::string renderer = "127.0.0.1:7402", tracker = "127.0.0.1:7401";
  LinkArguments link;  // but for the address
  bool check = false;
  bool json = false;
};

bool needs(const std::vector<Statement>& statements, bool tracker) {
  return std::any_of(statements.begin(), statements.end(), [&](const Statement& s) {
    if (s.kind == StatementKind::repeat) return needs(s.body, tracker);
    if (s.kind == StatementKind::request) return s.request.is_control == tracker;
    return tracker && (s.kind == StatementKind::expect_event || s.kind == StatementKind::expect_phase);
  });
}

class Runner {
 public:
  explicit Runner(const ScriptArguments& arguments) : arguments_(arguments) {}

  Result<void> open(const std::vector<Statement>& statements) {
    for (const bool tracker : {false, true}) {
      if (!needs(statements, tracker)) continue;
      LinkArguments where = arguments_.link;
      where.address = tracker ? arguments_.tracker : arguments_.renderer;
      auto link = open_link(where, Role::director, false);
      if (!link) return tl::make_unexpected(link.error());
      (tracker ? tracker_ : renderer_) = std::move(*link);
    }
    return {};
  }

  Result<void> run(const std::vector<Statement>& statements) {
    for (const Statement& statement : statements) {
      const std::int64_t start = monotonic_ns();
      auto done = one(statement);
      if (statement.kind != StatementKind::repeat || !done) tell(statement, done, monotonic_ns() - start);
      if (!done) return done;
    }
    return {};
  }

  // Everything that was started has to end well, unless something was expected of it.
  Result<void> finish() { return wait_for(all_open(), 60); }

 private:
  Result<void> one(const Statement& s) {
    switch (s.kind) {
      case StatementKind::request:
        return send(s);
      case StatementKind::wait:
        return wait_for(s.labels.empty() ? all_open() : ids_of(s.labels), s.seconds);
      case StatementKind::expect_command:
        return expect_command(s);
      case StatementKind::expect_event:
        return expect_event(s);
      case StatementKind::expect_phase:
        return until(
            s.seconds, [&] { return phase_ && *phase_ == s.phase; },
            "the game did not come to " + std::string(name_of(s.phase)) + phase_now());
      case StatementKind::sleep:
        return sleep(s.seconds);
      case StatementKind::repeat:
        for (int i = 0; i < s.times; ++i) {
          if (auto done = run(s.body); !done) return done;
        }
        return {};
      case StatementKind::print:
        return {};
    }
    return {};
  }

  Result<void> send(const Statement& s) {
    Request request = s.request;
    const std::uint64_t id = std::max(new_id(), last_id_ + 1);
    last_id_ = id;
    request.command.id = request.control.id = id;
    for (const std::uint64_t before : ids_of(s.labels)) request.command.after.push_back(before);
    const auto message = message_of(request);
    if (!message) return tl::make_unexpected(message.error());
    if (!s.label.empty()) ids_[s.label] = id;
    if (!request.is_control) answers_[id] = std::nullopt;
    (request.is_control ? tracker_ : renderer_)->broadcast(*message);
    return {};
  }

  std::vector<std::uint64_t> ids_of(const std::vector<std::string>& labels) const {
    std::vector<std::uint64_t> ids;
    for (const std::string& label : labels) ids.push_back(ids_.at(label));
    return ids;
  }

  std::vector<std::uint64_t> all_open() const {
    std::vector<std::uint64_t> ids;
    for (const auto& [id, answer] : answers_) {
      if (!answer) ids.push_back(id);
    }
    return ids;
  }

  Result<void> wait_for(const std::vector<std::uint64_t>& ids, double seconds) {
    const auto ended = [&](std::uint64_t id) { return answers_.at(id).has_value(); };
    return until(
        seconds, [&] { return std::all_of(ids.begin(), ids.end(), ended); }, "commands did not end");
  }

  Result<void> expect_command(const Statement& s) {
    const std::uint64_t id = ids_.at(s.labels.front());
    if (auto ended = wait_for({id}, s.seconds); !ended) return ended;
    const Feedback& answer = *answers_.at(id);
    if (answer.state == s.state && (s.code.empty() || s.code == answer.code)) return {};
    return failure(ErrorCode::invalid_argument, s.labels.front() + " " + std::string(name_of(answer.state)) +
                                                    (answer.code.empty() ? "" : ": " + answer.code));
  }

  // The next such event since the last one that was expected.
  Result<void> expect_event(const Statement& s) {
    const auto fits = [&] {
      while (!events_.empty()) {
        const GameEvent event = events_.front();
        events_.pop_front();
        if (event.kind == s.event && (s.code.empty() || s.code == event.code) &&
            (s.move.empty() || s.move == event.move)) {
          return true;
        }
      }
      return false;
    };
    return until(s.seconds, fits, "no such event came");
  }

  Result<void> sleep(double seconds) {
    const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
    while (monotonic_ns() < end && !stop_requested()) {
      if (auto fine = pump(end); !fine) return fine;
    }
    return {};
  }

  template <class Condition>
  Result<void> until(double seconds, Condition condition, const std::string& otherwise) {
    const std::int64_t end = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
    while (!condition()) {
      if (stop_requested()) return failure(ErrorCode::closed, "interrupted");
      if (monotonic_ns() >= end) {
        return failure(ErrorCode::timeout, otherwise + " within " + nlohmann::json(seconds).dump() + " s");
      }
      if (auto fine = pump(end); !fine) return fine;
    }
    return {};
  }

  Result<void> pump(std::int64_t until_ns) {
    const bool both = renderer_ != nullptr && tracker_ != nullptr;
    for (Endpoint* link : {renderer_.get(), tracker_.get()}) {
      if (link == nullptr) continue;
      const std::int64_t wait_ns =
          std::clamp<std::int64_t>(until_ns - monotonic_ns(), 0, both ? 2'000'000 : 50'000'000);
      for (const Inbound& inbound : link->receive(wait_ns)) {
        if (auto fine = note(inbound); !fine) return fine;
      }
    }
    if (renderer_ == nullptr && tracker_ == nullptr) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return {};
  }

  Result<void> note(const Inbound& inbound) {
    const auto* received = std::get_if<Received>(&inbound);
    if (received == nullptr) return {};
    if (const auto* report = std::get_if<ErrorReport>(&received->message)) {
      return failure(static_cast<ErrorCode>(report->code), report->message);
    }
    if (const auto* event = std::get_if<GameEvent>(&received->message)) {
      events_.push_back(*event);
      if (events_.size() > 10'000) events_.pop_front();
    }
    if (const auto* board = std::get_if<BoardState>(&received->message)) phase_ = board->phase;
    if (const auto* feedback = std::get_if<Feedback>(&received->message)) {
      const auto answer = answers_.find(feedback->command_id);
      if (answer != answers_.end() && is_final(feedback->state)) answer->second = *feedback;
    }
    return {};
  }

  std::string phase_now() const { return phase_ ? " (it is at " + std::string(name_of(*phase_)) + ")" : ""; }

  void tell(const Statement& s, const Result<void>& done, std::int64_t took_ns) const {
    const double ms = static_cast<double>(took_ns) / 1e6;
    if (arguments_.json) {
      const nlohmann::json line{{"line", s.line},
                                {"statement", s.text},
                                {"ok", done.has_value()},
                                {"ms", ms},
                                {"problem", done ? "" : done.error().message}};
      std::cout << line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
    } else if (s.kind == StatementKind::print) {
      std::cout << s.text << std::endl;
    } else if (done) {
      std::cout << "ok " << s.line << ": " << s.text << std::endl;
    }
    if (!done && !arguments_.json && s.kind != StatementKind::repeat) {
      std::cerr << "vhp: " << arguments_.file << ':' << s.line << ": " << s.text << ": " << done.error().message
                << '\n';
    }
  }

  const ScriptArguments& arguments_;
  std::unique_ptr<Endpoint> renderer_, tracker_;
  std::map<std::string, std::uint64_t> ids_;
  std::map<std::uint64_t, std::optional<Feedback>> answers_;
  std::deque<GameEvent> events_;
  std::optional<GamePhase> phase_;
  std::uint64_t last_id_ = 0;
};

int run_script(const ScriptArguments& arguments) {
  std::ifstream file(arguments.file);
  const bool from_stdin = arguments.file == "-";
  if (!from_stdin && !file) return fail({ErrorCode::not_found, "the script " + arguments.file + " cannot be opened"});
  std::istream& in = from_stdin ? std::cin : file;
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  auto statements = parse_script(text, arguments.file);
  if (!statements) {
    std::cerr << "vhp: " << statements.error().message << '\n';
    return kWrongUsage;
  }
  if (arguments.check) return kFine;
  Runner runner(arguments);
  if (auto opened = runner.open(*statements); !opened) return fail(opened.error());
  if (!runner.run(*statements)) return kFailed;
  if (auto finished = runner.finish(); !finished) return fail(finished.error());
  return kFine;
}

}  // namespace

void add_script(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ScriptArguments>();
  CLI::App* command = app.add_subcommand("script", "Runs a scenario: commands, waits, loops and expectations");
  command->add_option("file", arguments->file, "The scenario; - reads it from stdin")->required();
  command->add_option("--renderer", arguments->renderer, "Where commands go")->capture_default_str();
  command->add_option("--tracker", arguments->tracker, "Where controls go and events come from")->capture_default_str();
  add_security(*command, arguments->link);
  command->add_option("--patience", arguments->link.patience_s, "Seconds to wait for the peers")
      ->check(CLI::PositiveNumber);
  command->add_flag("--check", arguments->check, "Only read the scenario");
  command->add_flag("--json", arguments->json, "One JSON object for every statement");
  command->callback([arguments, &exit_code] { exit_code = run_script(*arguments); });
}

}  // namespace counterpart::vhp
