// Commands of several directors under one numbering, so that their own ids cannot meet, and feedback back to the one
// who asked.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "protocol/vocabulary/command.hpp"

namespace counterpart {

using DirectorId = std::uint32_t;

class CommandRelay {
 public:
  // Relayed commands are numbered from `first_id` on. Ranges of different relays must not meet.
  explicit CommandRelay(std::uint64_t first_id) : first_id_(first_id), next_id_(first_id) {}

  // The command with ids of this relay; the same director's same id gets the same number again.
  Command forward(DirectorId director, const Command& command);

  struct Answer {
    DirectorId director = 0;
    Feedback feedback;  // with the director's own id
  };
  // Empty if the feedback is for none of this relay's commands.
  std::optional<Answer> answer(const Feedback& feedback);

  bool owns(std::uint64_t id) const { return id >= first_id_ && id < next_id_; }

 private:
  struct Origin {
    DirectorId director = 0;
    std::uint64_t id = 0;
    friend auto operator<=>(const Origin&, const Origin&) = default;
  };

  std::uint64_t number(const Origin& origin);

  std::uint64_t first_id_;
  std::uint64_t next_id_;
  std::map<Origin, std::uint64_t> numbers_;
  std::map<std::uint64_t, Origin> origins_;
};

}  // namespace counterpart
