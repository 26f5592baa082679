#include <iostream>

#include <CLI/CLI.hpp>

#include "protocol/codec/json.hpp"
#include "protocol/codec/names.hpp"
#include "protocol/daemon/stop_signal.hpp"
#include "protocol/transport/monotonic_clock.hpp"
#include "protocol/vhp/commands.hpp"
#include "protocol/vhp/common.hpp"
#include "protocol/vhp/request.hpp"

namespace counterpart::vhp {
namespace {

struct SendArguments {
  LinkArguments link;
  std::shared_ptr<Request> request = std::make_shared<Request>();
  double timeout_s = 60;
  bool no_wait = false;
  bool json = false;
};

void print_feedback(const SendArguments& arguments, const Feedback& feedback) {
  if (arguments.json) {
    std::cout << to_json_text(feedback) << std::endl;
    return;
  }
  std::cout << feedback.command_id << ' ' << name_of(feedback.state);
  if (!feedback.phase.empty()) std::cout << ' ' << feedback.phase;
  if (!feedback.code.empty()) std::cout << ": " << feedback.code;
  if (feedback.gap_mm >= 0) std::cout << " (" << feedback.gap_mm << " mm away)";
  std::cout << std::endl;
}

int wait_for_answer(const SendArguments& arguments, Endpoint& endpoint) {
  const std::int64_t until = monotonic_ns() + static_cast<std::int64_t>(arguments.timeout_s * 1e9);
  while (!stop_requested() && monotonic_ns() < until) {
    for (const Inbound& inbound : endpoint.receive(50'000'000)) {
      if (const auto* left = std::get_if<PeerLeft>(&inbound)) std::cerr << "away: " << left->reason.message << '\n';
      const auto* received = std::get_if<Received>(&inbound);
      if (received == nullptr) continue;
      if (const auto* report = std::get_if<ErrorReport>(&received->message)) {
        return fail({static_cast<ErrorCode>(report->code), report->message});
      }
      const auto* feedback = std::get_if<Feedback>(&received->message);
      if (feedback == nullptr || feedback->command_id != arguments.request->command.id) continue;
      print_feedback(arguments, *feedback);
      if (is_final(feedback->state)) return feedback->state == FeedbackState::finished ? kFine : kFailed;
    }
  }
  return fail({ErrorCode::timeout, "no final answer to command " + std::to_string(arguments.request->command.id) +
                                       " within " + std::to_string(arguments.timeout_s) + " s"});
}

// Until the other side has it: a kept message is acknowledged, then nothing waits any more.
int wait_until_taken(Endpoint& endpoint) {
  const std::int64_t until = monotonic_ns() + 3'000'000'000;
  while (!stop_requested() && monotonic_ns() < until) {
    for (const Inbound& inbound : endpoint.receive(10'000'000)) {
      const auto* received = std::get_if<Received>(&inbound);
      const auto* report = received == nullptr ? nullptr : std::get_if<ErrorReport>(&received->message);
      if (report != nullptr) return fail({static_cast<ErrorCode>(report->code), report->message});
    }
    const auto stats = endpoint.stats();
    if (!stats.empty() && stats.front().unacknowledged == 0) return kFine;
  }
  return fail({ErrorCode::timeout, "the peer did not take the message within 3 s"});
}

int run_send(SendArguments& arguments) {
  Request& request = *arguments.request;
  if (arguments.link.address.empty()) {
    arguments.link.address = request.is_control ? "127.0.0.1:7401" : "127.0.0.1:7402";
  }
  if (request.command.id == 0) request.command.id = new_id();
  request.control.id = request.command.id;
  const auto message = message_of(request);
  if (!message) return fail({ErrorCode::invalid_argument, message.error().message});
  auto endpoint = open_link(arguments.link, Role::director, false);
  if (!endpoint) return fail(endpoint.error());
  (*endpoint)->broadcast(*message);
  if (request.is_control || arguments.no_wait) return wait_until_taken(**endpoint);
  return wait_for_answer(arguments, **endpoint);
}

}  // namespace

void add_send(CLI::App& app, int& exit_code) {
  auto a = std::make_shared<SendArguments>();
  CLI::App* send = app.add_subcommand("send", "Sends one command (or control) and waits for its final answer");
  send->require_subcommand(1);
  send->add_option("--to", a->link.address,
                   "HOST:PORT; default: the renderer at 127.0.0.1:7402, for control the tracker at 127.0.0.1:7401");
  send->add_option("--timeout", a->timeout_s, "Seconds to wait for the final answer")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  send->add_flag("--no-wait", a->no_wait, "Only until the peer has taken it");
  add_security(*send, a->link);
  send->add_flag("--json", a->json, "Answers as JSON lines");
  add_request(*send, a->request);
  send->callback([a, &exit_code] { exit_code = run_send(*a); });
}

}  // namespace counterpart::vhp
