#include <iostream>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "protocol/daemon/stop_signal.hpp"
#include "protocol/transport/monotonic_clock.hpp"
#include "protocol/vhp/commands.hpp"
#include "protocol/vhp/common.hpp"

namespace counterpart::vhp {
namespace {

struct RecordArguments {
  LinkArguments link;
  std::string file;
  double seconds = 0;
  bool no_video = false;
  bool json = false;
};

int run_record(const RecordArguments& arguments) {
  auto endpoint = open_link(arguments.link, Role::observer, !arguments.no_video, arguments.file);
  if (!endpoint) return fail(endpoint.error());
  std::cerr << "recording " << (*endpoint)->address() << " into " << arguments.file << "; Ctrl-C ends it\n";
  const std::int64_t start = monotonic_ns();
  std::uint64_t messages = 0;
  while (!stop_requested()) {
    if (arguments.seconds > 0 && static_cast<double>(monotonic_ns() - start) >= arguments.seconds * 1e9) break;
    for (const Inbound& inbound : (*endpoint)->receive(100'000'000)) {
      if (const auto* left = std::get_if<PeerLeft>(&inbound)) std::cerr << "away: " << left->reason.message << '\n';
      if (std::holds_alternative<PeerJoined>(inbound)) std::cerr << "connected\n";
      const auto* received = std::get_if<Received>(&inbound);
      if (received == nullptr) continue;
      ++messages;
      const auto* report = std::get_if<ErrorReport>(&received->message);
      if (report != nullptr && received->peer == 0) {
        return fail({static_cast<ErrorCode>(report->code), report->message});
      }
    }
  }
  endpoint->reset();  // finishes the file
  if (arguments.json) {
    std::cout << nlohmann::json{{"file", arguments.file}, {"messages", messages}} << '\n';
  } else {
    std::cout << messages << " messages in " << arguments.file << '\n';
  }
  return kFine;
}

}  // namespace

void add_record(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<RecordArguments>();
  CLI::App* command = app.add_subcommand("record", "Captures everything that a tracker (or renderer, or stage) sends");
  command->add_option("address", arguments->link.address, "HOST:PORT")->required();
  command->add_option("file", arguments->file, "The capture to write, for example game.mcap")->required();
  command->add_option("--for", arguments->seconds, "Stop after so many seconds (0: on Ctrl-C)")
      ->check(CLI::NonNegativeNumber);
  add_security(*command, arguments->link);
  command->add_flag("--no-video", arguments->no_video, "Without the pictures");
  command->add_flag("--json", arguments->json, "Result as JSON");
  command->callback([arguments, &exit_code] { exit_code = run_record(*arguments); });
}

}  // namespace counterpart::vhp
