// Compares the rules with positions whose legal moves or counts are known.
#pragma once

#include <iosfwd>
#include <string>

#include "game_controller/rules/rules.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// file: {"positions": [{"fen": FEN, "perft": [count at depth 1, 2, ...]} or {"fen": FEN, "legal": [moves]}, ...]}.
// A line a position on `out`. False if one differs; fails if the file cannot be read. Counts above `most_leaves` are
// left out, and said to be.
[[nodiscard]] Result<bool> check_positions(const Rules& rules, const std::string& file, double most_leaves,
                                           std::ostream& out);

// Reads the PDN file, writes all its games strictly to `out`.
[[nodiscard]] Result<void> rewrite_pdn(const std::string& file, std::ostream& out);

}  // namespace counterpart
