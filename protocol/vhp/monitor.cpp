#include <cstdio>
#include <iostream>
#include <map>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "protocol/codec/json.hpp"
#include "protocol/codec/names.hpp"
#include "protocol/daemon/stop_signal.hpp"
#include "protocol/transport/monotonic_clock.hpp"
#include "protocol/vhp/commands.hpp"
#include "protocol/vhp/common.hpp"

namespace counterpart::vhp {
namespace {

using nlohmann::json;

constexpr std::int64_t kSecond = 1'000'000'000;

struct MonitorArguments {
  LinkArguments link{"127.0.0.1:7401", "", 3};
  double seconds = 0;
  double every_s = 1;
  bool json = false;
  bool video = false;
};

// What has come since the last line, and the latest of what lasts.
struct Picture {
  std::map<MessageType, std::uint64_t> counts, totals;
  std::optional<PoseEstimate> pose;
  std::int64_t pose_received_ns = 0;
  std::optional<BoardState> board;
  std::optional<GameEvent> event;
  bool connected = true;
  std::string trouble;
};

void note(Picture& picture, const Inbound& inbound) {
  if (std::holds_alternative<PeerJoined>(inbound)) {
    picture.connected = true;
    picture.trouble.clear();
  } else if (const auto* left = std::get_if<PeerLeft>(&inbound)) {
    picture.connected = false;
    picture.trouble = left->reason.message;
  } else {
    const auto& received = std::get<Received>(inbound);
    ++picture.counts[type_of(received.message)];
    ++picture.totals[type_of(received.message)];
    if (const auto* pose = std::get_if<PoseEstimate>(&received.message)) {
      picture.pose = *pose;
      picture.pose_received_ns = received.received_ns;
    }
    if (const auto* board = std::get_if<BoardState>(&received.message)) picture.board = *board;
    if (const auto* event = std::get_if<GameEvent>(&received.message)) picture.event = *event;
  }
}

json summary(const Picture& picture, const Endpoint& endpoint, double seconds) {
  json out{{"peer", endpoint.address()}, {"connected", picture.connected}, {"trouble", picture.trouble}};
  for (const auto& [type, total] : picture.totals) {
    const auto count = picture.counts.count(type) > 0 ? picture.counts.at(type) : 0;
    out["messages"][std::string(name_of(type))] = {{"per_s", static_cast<double>(count) / seconds}, {"total", total}};
  }
  for (const PeerStats& peer : endpoint.stats()) {
    out["link"] = {{"round_trip_ms", static_cast<double>(peer.round_trip_ns) / 1e6},
                   {"clock_offset_ms", static_cast<double>(peer.clock_offset_ns) / 1e6},
                   {"clock_bound_ms", static_cast<double>(peer.clock_bound_ns) / 1e6},
                   {"dropped", peer.dropped},
                   {"skipped", peer.skipped},
                   {"bytes_received", peer.bytes_received}};
    if (picture.pose && peer.clock_bound_ns >= 0) {
      const std::int64_t age_ns = picture.pose_received_ns + peer.clock_offset_ns - picture.pose->stamp.capture_ns;
      out["pose_age_ms"] = static_cast<double>(age_ns) / 1e6;
    }
  }
  if (picture.pose) out["pose"] = to_json(*picture.pose);
  if (picture.board) out["board_state"] = to_json(*picture.board);
  if (picture.event) out["last_event"] = to_json(*picture.event);
  return out;
}

void print_table(const Picture& picture, const json& all, bool live) {
  if (live) std::printf("\033[H\033[J");
  std::printf("%s  %s\n", all["peer"].get<std::string>().c_str(),
              picture.connected ? "connected" : ("away: " + picture.trouble).c_str());
  if (all.contains("link")) {
    const json& link = all["link"];
    std::printf("round trip %.3f ms   clock %+.3f ms (+-%.3f)   dropped %llu   skipped %llu\n",
                link["round_trip_ms"].get<double>(), link["clock_offset_ms"].get<double>(),
                link["clock_bound_ms"].get<double>(), link["dropped"].get<unsigned long long>(),
                link["skipped"].get<unsigned long long>());
  }
  if (all.contains("messages")) {
    for (const auto& [name, rate] : all["messages"].items()) {
      std::printf("  %-16s %8.1f /s  %10llu\n", name.c_str(), rate["per_s"].get<double>(),
                  rate["total"].get<unsigned long long>());
    }
  }
  if (picture.pose) {
    const std::string age = all.contains("pose_age_ms") ? std::to_string(all["pose_age_ms"].get<double>()) : "?";
    std::printf("  frame %llu  pose %s  rms %.2f px  age %s ms\n",
                static_cast<unsigned long long>(picture.pose->stamp.frame_id),
                std::string(name_of(picture.pose->status)).c_str(), static_cast<double>(picture.pose->rms_px),
                age.c_str());
  }
  if (picture.board) {
    std::printf("  game: %s, %s to move, %zu moves", std::string(name_of(picture.board->phase)).c_str(),
                std::string(name_of(picture.board->turn)).c_str(), picture.board->moves.size());
    if (!picture.board->moves.empty()) std::printf(", last %s", picture.board->moves.back().c_str());
    std::printf("\n");
  }
  if (picture.event) {
    std::printf("  event %llu: %s %s %s\n", static_cast<unsigned long long>(picture.event->id),
                std::string(name_of(picture.event->kind)).c_str(), picture.event->code.c_str(),
                picture.event->move.c_str());
  }
  std::fflush(stdout);
}

int run_monitor(const MonitorArguments& arguments) {
  auto endpoint = open_link(arguments.link, Role::observer, arguments.video);
  if (!endpoint) return fail(endpoint.error());
  const bool live = isatty(STDOUT_FILENO) != 0;
  const std::int64_t start = monotonic_ns();
  std::int64_t last = start;
  Picture picture;
  while (!stop_requested() && std::cout.good()) {
    for (const Inbound& inbound : (*endpoint)->receive(kSecond / 20)) note(picture, inbound);
    const std::int64_t time = monotonic_ns();
    const bool end = arguments.seconds > 0 && static_cast<double>(time - start) >= arguments.seconds * 1e9;
    if (!end && static_cast<double>(time - last) < arguments.every_s * 1e9) continue;
    const json all = summary(picture, **endpoint, static_cast<double>(time - last) / 1e9);
    if (arguments.json) {
      std::cout << all.dump(-1, ' ', false, json::error_handler_t::replace) << std::endl;
    } else {
      print_table(picture, all, live);
    }
    picture.counts.clear();
    last = time;
    if (end) break;
  }
  return kFine;
}

}  // namespace

void add_monitor(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<MonitorArguments>();
  CLI::App* command = app.add_subcommand("monitor", "Shows rates, delays, drops and the state of the game, live");
  command->add_option("address", arguments->link.address, "HOST:PORT of the tracker (or renderer, or stage)")
      ->capture_default_str();
  command->add_option("--for", arguments->seconds, "Stop after so many seconds (0: on Ctrl-C)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--every", arguments->every_s, "Seconds between lines")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_security(*command, arguments->link);
  command->add_flag("--video", arguments->video, "Fetch the pictures, too, and count them");
  command->add_flag("--json", arguments->json, "One JSON object a line");
  command->callback([arguments, &exit_code] { exit_code = run_monitor(*arguments); });
}

}  // namespace counterpart::vhp
