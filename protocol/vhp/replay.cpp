#include <algorithm>
#include <chrono>
#include <iostream>
#include <thread>

#include <CLI/CLI.hpp>

#include "protocol/capture/session_reader.hpp"
#include "protocol/codec/names.hpp"
#include "protocol/daemon/stop_signal.hpp"
#include "protocol/transport/monotonic_clock.hpp"
#include "protocol/vhp/commands.hpp"
#include "protocol/vhp/common.hpp"

namespace counterpart::vhp {
namespace {

struct ReplayArguments {
  std::string file;
  std::string role;
  std::string listen, connect;
  LinkArguments link;  // but for address and patience
  double speed = 1;
  bool lockstep = false;
  double patience_s = 60;
};

Result<std::unique_ptr<Endpoint>> open_end(const ReplayArguments& arguments, Role role) {
  LinkOptions options;
  options.role = role;
  options.software = "vhp " COUNTERPART_VERSION " replay";
  options.token_file = arguments.link.token_file;
  options.tls_file = arguments.link.tls_file;
  options.lockstep = arguments.lockstep;
  options.takes_h264 = true;  // nobody looks at the pictures here
  if (!arguments.listen.empty()) return listen_tcp(arguments.listen, options);
  return connect_tcp(arguments.connect, options, static_cast<std::int64_t>(arguments.patience_s * 1e9));
}

// What paces a lockstep: the frames that the other side has done (for a tracker, a camera) or has sent (for a
// renderer).
std::optional<FrameId> pace_of(const Message& message, Role role) {
  const auto* done = std::get_if<FrameDone>(&message);
  const auto* pose = std::get_if<PoseEstimate>(&message);
  if (role == Role::renderer) return pose == nullptr ? std::nullopt : std::optional(pose->stamp.frame_id);
  return done == nullptr ? std::nullopt : std::optional(done->stamp.frame_id);
}

// The live peer.
class LivePeer {
 public:
  LivePeer(Endpoint& endpoint, Role role) : endpoint_(endpoint), role_(role) {}

  void listen(std::int64_t timeout_ns) {
    for (const Inbound& inbound : endpoint_.receive(timeout_ns)) {
      joined_ |= std::holds_alternative<PeerJoined>(inbound);
      const auto* received = std::get_if<Received>(&inbound);
      const auto frame = received == nullptr ? std::nullopt : pace_of(received->message, role_);
      if (frame) at_ = std::max(at_.value_or(0), *frame);
    }
  }

  template <class Condition>
  bool wait(double seconds, Condition condition) {
    const std::int64_t until = monotonic_ns() + static_cast<std::int64_t>(seconds * 1e9);
    while (!condition()) {
      if (stop_requested() || monotonic_ns() >= until) return false;
      listen(20'000'000);
    }
    return true;
  }

  bool joined() const { return joined_; }
  bool has_reached(std::optional<FrameId> frame) const { return !frame || (at_ && *at_ >= *frame); }

 private:
  Endpoint& endpoint_;
  Role role_;
  bool joined_ = false;
  std::optional<FrameId> at_;
};

// Reads away what the live peer answers, so that it never has to wait for us.
void wait_until(LivePeer& peer, std::int64_t when_ns) {
  do {
    peer.listen(std::clamp<std::int64_t>(when_ns - monotonic_ns(), 0, 20'000'000));
  } while (!stop_requested() && monotonic_ns() < when_ns);
}

int play(const ReplayArguments& arguments, SessionReader& reader, Endpoint& endpoint, LivePeer& peer, Role role) {
  std::optional<FrameId> gate;  // how far the other side was when this was said
  std::uint64_t sent = 0;
  std::int64_t capture_start = 0, start = 0;
  while (!stop_requested()) {
    auto recorded = reader.next();
    if (!recorded) break;
    if (!reader.sent_by(role, *recorded)) {
      if (const auto frame = pace_of(recorded->message, role)) gate = std::max(gate.value_or(0), *frame);
      continue;
    }
    if (sent == 0) {
      capture_start = recorded->log_ns;
      start = monotonic_ns();
    }
    if (arguments.lockstep) {
      if (!peer.wait(arguments.patience_s, [&] { return peer.has_reached(gate); })) {
        return fail({ErrorCode::timeout, "the peer did not come to frame " + std::to_string(gate.value_or(0))});
      }
    } else if (arguments.speed > 0) {
      const auto after = static_cast<double>(recorded->log_ns - capture_start) / arguments.speed;
      wait_until(peer, start + static_cast<std::int64_t>(after));
    }
    endpoint.broadcast(recorded->message);
    ++sent;
  }
  if (reader.problem()) std::cerr << "vhp: " << reader.problem()->message << '\n';
  if (sent == 0) {
    return fail({ErrorCode::not_found, arguments.file + " holds nothing that a " + arguments.role + " sent"});
  }
  wait_until(peer, monotonic_ns() + 500'000'000);
  std::cout << sent << " messages replayed as " << arguments.role << '\n';
  std::uint64_t dropped = 0;
  for (const PeerStats& stats : endpoint.stats()) dropped += stats.dropped;
  if (dropped > 0)
    std::cerr << "vhp: " << dropped << " of them were replaced by newer ones, or not taken by the peer\n";
  return stop_requested() ? kFailed : kFine;
}

int run_replay(const ReplayArguments& arguments) {
  const auto role = from_name<Role>(arguments.role);
  auto reader = SessionReader::open(arguments.file);
  if (!reader) return fail(reader.error());
  auto endpoint = open_end(arguments, *role);
  if (!endpoint) return fail(endpoint.error());
  if (!arguments.listen.empty()) std::cerr << "waiting for a peer on " << (*endpoint)->address() << '\n';
  LivePeer peer(**endpoint, *role);
  if (!peer.wait(arguments.patience_s, [&] { return peer.joined(); })) {
    return fail({ErrorCode::timeout, "no peer came within " + std::to_string(arguments.patience_s) + " s"});
  }
  return play(arguments, **reader, **endpoint, peer, *role);
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReplayArguments>();
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
  command->add_flag("--lockstep", arguments->lockstep, "By the frames of the live peer instead of by time");
  command->add_option("--patience", arguments->patience_s, "Seconds to wait for the peer")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_security(*command, arguments->link);
  command->callback([arguments, &exit_code] {
    if (arguments->listen.empty() == arguments->connect.empty()) {
      throw CLI::ValidationError("replay", "give --listen HOST:PORT or --connect HOST:PORT");
    }
    exit_code = run_replay(*arguments);
  });
}

}  // namespace counterpart::vhp
