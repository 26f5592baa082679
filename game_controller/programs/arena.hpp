// Measures players of this program against each other: by nodes, the same games on every machine, or by the clock.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct ArenaOptions {
  std::string a = "trained";  // "level:3", or "trained", "plain", "material" at the nodes below,
  std::string b = "plain";    // or "weights:FILE": trained with the weights of a file
  int games = 100;
  std::uint64_t nodes = 20'000;
  double move_time_s = 0;  // instead of the nodes, for players that are no level; 0: by nodes
  int random_plies = 4;    // at the start; each start is played twice with colours swapped
  std::uint64_t seed = 1;
};

// International rules. One JSON object on `out`: wins, draws, losses and score of a, and how fast both searched.
[[nodiscard]] Result<void> run_arena(const ArenaOptions& options, std::ostream& out, std::ostream& log);

}  // namespace counterpart
