// The program's player over DXP.
#pragma once

#include <iosfwd>
#include <string>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct DxpOptions {
  std::string listen;      // HOST:PORT or PORT; or
  std::string connect;     // the same: the other side listens
  int level = 0;           // 1-8; 0: full strength
  double move_time_s = 0;  // 0: by the clock that was agreed on
  int minutes = 30;        // asked for when connecting
  int moves = 0;
  bool dark = false;        // we play the dark pieces when connecting
  std::string fen;          // start when connecting; empty: the usual one
  int games = 0;            // 0: no limit when listening, one when connecting
  double patience_s = 600;  // for the other side
  std::string pdn_file;     // every game is saved there as it goes; empty: not saved
};

// A JSON line a game on standard output (the games go on if nobody reads it), everything else to `log`. Standard input
// is read for "time MILLISECONDS" (a move) and "quit".
[[nodiscard]] Result<void> run_dxp(const DxpOptions& options, std::ostream& log);

}  // namespace counterpart
