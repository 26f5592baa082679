#include "vhd_renderer/pipeline/director_port.hpp"

#include <utility>

namespace counterpart {
namespace {

// Above the numbers of the game (from 1) and of directors relayed by the tracker (from 2^48).
constexpr std::uint64_t kFirstId = std::uint64_t{1} << 52;

}  // namespace

DirectorPort::DirectorPort(std::unique_ptr<Endpoint> link) : link_(std::move(link)), relay_(kFirstId) {}

std::vector<Command> DirectorPort::take_commands() {
  std::vector<Command> out;
  if (!link_) return out;
  for (const Inbound& inbound : link_->receive(0)) {
    const auto* received = std::get_if<Received>(&inbound);
    if (received == nullptr) continue;
    if (const auto* command = std::get_if<Command>(&received->message)) {
      out.push_back(relay_.forward(received->peer, *command));
    }
  }
  return out;
}

bool DirectorPort::answer(const Feedback& feedback) {
  const auto answer = relay_.answer(feedback);
  if (!answer) return false;
  link_->send(answer->director, answer->feedback);
  return true;
}

}  // namespace counterpart
