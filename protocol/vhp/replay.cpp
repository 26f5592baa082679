#include <algorithm>
#include <chrono>
#include <iostream>
#include <thread>

#include <CLI/CLI.hpp>

#include "protocol/capture/session_reader.hpp"
#include "protocol/codec/names.hpp"
#include "protocol/vhp/commands.hpp"
#include "protocol/vhp/common.hpp"

namespace counterpart::vhp {
namespace {

struct Arguments {
  std::string file;
  std::string role;
  std::string listen, connect;
  std::string token_file;
  double speed = 1;
  double patience_s = 60;
};

Result<std::unique_ptr<Endpoint>> open_end(const Arguments& arguments, Role role) {
  LinkOptions options;
  options.role = role;
  options.software = "vhp " COUNTERPART_VERSION " replay";
  options.token_file = arguments.token_file;
  if (!arguments.listen.empty()) return listen_tcp(arguments.listen, options);
  return connect_tcp(arguments.connect, options, static_cast<std::int64_t>(arguments.patience_s * 1e9));
}

bool wait_for_peer(Endpoint& endpoint, double patience_s) {
  const std::int64_t until = monotonic_ns() + static_cast<std::int64_t>(patience_s * 1e9);
  while (!interrupted() && monotonic_ns() < until) {
    for (const Inbound& inbound : endpoint.receive(50'000'000)) {
      if (std::holds_alternative<PeerJoined>(inbound)) return true;
    }
  }
  return false;
}

// Reads away what the live peer answers, so that it never has to wait for us.
void wait_until(Endpoint& endpoint, std::int64_t when_ns) {
  do {
    const std::int64_t left = when_ns - monotonic_ns();
    static_cast<void>(endpoint.receive(std::clamp<std::int64_t>(left, 0, 20'000'000)));
  } while (!interrupted() && monotonic_ns() < when_ns);
}

int play(const Arguments& arguments, SessionReader& reader, Endpoint& endpoint, Role role) {
  std::uint64_t sent = 0;
  std::int64_t capture_start = 0, start = 0;
  while (!interrupted()) {
    auto recorded = reader.next();
    if (!recorded) break;
    if (!reader.sent_by(role, *recorded)) continue;
    if (sent == 0) {
      capture_start = recorded->log_ns;
      start = monotonic_ns();
    }
    if (arguments.speed > 0) {
      const auto after = static_cast<double>(recorded->log_ns - capture_start) / arguments.speed;
      wait_until(endpoint, start + static_cast<std::int64_t>(after));
    }
    endpoint.broadcast(recorded->message);
    ++sent;
  }
  if (reader.problem()) std::cerr << "vhp: " << reader.problem()->message << '\n';
  if (sent == 0) {
    return fail({ErrorCode::not_found, arguments.file + " holds nothing that a " + arguments.role + " sent"});
  }
  wait_until(endpoint, monotonic_ns() + 500'000'000);
  std::cout << sent << " messages replayed as " << arguments.role << '\n';
  return interrupted() ? kFailed : kFine;
}

int run(const Arguments& arguments) {
  const auto role = from_name<Role>(arguments.role);
  auto reader = SessionReader::open(arguments.file);
  if (!reader) return fail(reader.error());
  auto endpoint = open_end(arguments, *role);
  if (!endpoint) return fail(endpoint.error());
  if (!arguments.listen.empty()) std::cerr << "waiting for a peer on " << (*endpoint)->address() << '\n';
  if (!wait_for_peer(**endpoint, arguments.patience_s)) {
    return fail({ErrorCode::timeout, "no peer came within " + std::to_string(arguments.patience_s) + " s"});
  }
  return play(arguments, **reader, **endpoint, *role);
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("replay", "Plays one side of a capture to a live peer");
  command->add_option("file", arguments->file, "The capture")->required()->check(CLI::ExistingFile);
  command->add_option("--as", arguments->role, "Whose messages: tracker, renderer or camera")
      ->required()
      ->check(CLI::IsMember({"tracker", "renderer", "camera"}));
  auto* listen = command->add_option("--listen", arguments->listen, "Wait for the peer on HOST:PORT");
  auto* connect = command->add_option("--connect", arguments->connect, "Go to the peer at HOST:PORT");
  listen->excludes(connect);
  command->add_option("--speed", arguments->speed, "1: as recorded; 0: as fast as it goes")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--patience", arguments->patience_s, "Seconds to wait for the peer")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--token-file", arguments->token_file, "The shared token, for other hosts");
  command->callback([arguments, &exit_code] {
    if (arguments->listen.empty() == arguments->connect.empty()) {
      throw CLI::ValidationError("replay", "give --listen HOST:PORT or --connect HOST:PORT");
    }
    exit_code = run(*arguments);
  });
}

}  // namespace counterpart::vhp
