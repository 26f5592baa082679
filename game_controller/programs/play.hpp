// A game in the terminal.
#pragma once

#include <iosfwd>
#include <string>

#include "game_controller/rules/rules.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct PlayOptions {
  int level = 4;
  std::string fen;       // empty: the usual start
  std::string pdn_file;  // empty: not saved
  bool dark = false;     // the person plays the dark pieces
};

// Ends with the game, with "quit" or with the end of input.
[[nodiscard]] Result<void> play_in_terminal(const Rules& rules, const PlayOptions& options, std::istream& in,
                                            std::ostream& out);

}  // namespace counterpart
