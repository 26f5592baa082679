// Who finds the virtual player's moves. The daemon asks, goes on with its frames, and polls.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct OpponentOptions {
  std::string rules = "international";
  int level = 4;           // 1..8
  bool lockstep = false;   // searches by nodes inside `poll`, reads no clock: two runs give the same moves
  std::uint64_t seed = 1;  // of the choice among near-equal moves
  // Empty: this program's engine; "hub:COMMAND": any Hub 2 engine, started by that command line; "dxp:HOST:PORT": a
  // program or person that listens there.
  std::string mind;
  double move_time_s = 1;  // that a Hub engine has for a move
};

// Said as a move: the game is given up. An engine or distant player that dies, keeps silent or makes an illegal move
// does so.
inline constexpr const char* opponent_resigns = "resigns";

struct OpponentMove {
  std::string move;               // as in PDN with the whole path: "32-28", "47x38x24x13x36"; or opponent_resigns
  double score = 0;               // in men, for the side that moves
  std::vector<std::string> line;  // expected continuation, this move first
  double acted_thinking_s = 0;    // how long a person would seem to think about it
  std::string note;               // with opponent_resigns: why
};

class Opponent {
 public:
  virtual ~Opponent() = default;
  // Any older search is dropped.
  virtual void think(const std::string& fen) = 0;
  // The answer to the last `think`, once; empty while there is none.
  virtual std::optional<Result<OpponentMove>> poll() = 0;
};

[[nodiscard]] Result<std::unique_ptr<Opponent>> make_opponent(const OpponentOptions& options);

}  // namespace counterpart
