#include "protocol/session/command_relay.hpp"

#include <variant>

namespace counterpart {
namespace {

// Answered commands are remembered for a while, since a director may send one again after a lost link.
constexpr std::size_t kRemembered = 10'000;

}  // namespace

std::uint64_t CommandRelay::number(const Origin& origin) {
  const auto [found, fresh] = numbers_.try_emplace(origin, next_id_);
  if (fresh) origins_.emplace(next_id_++, origin);
  if (origins_.size() > kRemembered) {
    numbers_.erase(origins_.begin()->second);
    origins_.erase(origins_.begin());
  }
  return found->second;
}

Command CommandRelay::forward(DirectorId director, const Command& command) {
  Command out = command;
  out.id = number({director, command.id});
  for (std::uint64_t& id : out.after) id = number({director, id});
  if (auto* stop = std::get_if<Stop>(&out.action)) {
    for (std::uint64_t& id : stop->commands) id = number({director, id});
  }
  return out;
}

std::optional<CommandRelay::Answer> CommandRelay::answer(const Feedback& feedback) {
  const auto found = origins_.find(feedback.command_id);
  if (found == origins_.end()) return std::nullopt;
  Answer out{found->second.director, feedback};
  out.feedback.command_id = found->second.id;
  return out;
}

}  // namespace counterpart
