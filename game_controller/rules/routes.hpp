// The whole way of a capture. Slow and plain: for people, the referee and notation; searches use generate.hpp.
#pragma once

#include <vector>

#include "game_controller/rules/move.hpp"
#include "game_controller/rules/position.hpp"
#include "game_controller/rules/rules.hpp"

namespace counterpart {

struct Route {
  std::vector<int> squares;   // from, every landing, to (square numbers)
  std::vector<int> captured;  // in the order they are jumped; empty for a move without capture
  bool complete = true;       // false: the piece could go on capturing from here
};

enum class JumpedPieces {
  stay_and_block,  // as the rules say (FMJD Annex 1 art. 4.8)
  leave_at_once,   // what a player does who takes each piece off as he jumps it: shows what is wrong with such a move
};

// Every capture that the piece on `from` (a bit) can begin, prefixes of longer ones included, whatever the majority
// rule says. At most 20,000 are listed.
std::vector<Route> capture_routes(const Rules& rules, const Position& position, int from,
                                  JumpedPieces jumped = JumpedPieces::stay_and_block);

// All ways of playing this legal move; at least one.
std::vector<Route> routes(const Rules& rules, const Position& position, const Move& move);

Bits bits_of_squares(const std::vector<int>& squares, int squares_a_side);
std::vector<int> squares_of_bits(Bits bits, int squares_a_side);

}  // namespace counterpart
