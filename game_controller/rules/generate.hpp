// Legal moves. All functions take the rules as an argument and do not change the position.
#pragma once

#include <cstdint>

#include "game_controller/rules/move.hpp"
#include "game_controller/rules/position.hpp"
#include "game_controller/rules/rules.hpp"

namespace counterpart {

// Every legal move, each (from, to, captured) once.
void generate(const Rules& rules, const Position& position, MoveList& moves);

// Legal captures only; empty when there is none.
void generate_captures(const Rules& rules, const Position& position, MoveList& moves);

// Moves without capture, whether or not a capture would be compulsory.
void generate_quiet(const Rules& rules, const Position& position, MoveList& moves);

bool can_capture(const Rules& rules, const Position& position);

// A move without capture, whether or not a capture would be compulsory.
bool has_quiet_move(const Rules& rules, const Position& position);

bool has_move(const Rules& rules, const Position& position);

// The position after a move that `generate` gave: a man that ends on the far row is crowned (FMJD Annex 1
// art. 3.5, 4.15).
Position after(const Rules& rules, const Position& position, const Move& move);

// Leaves of the tree of legal moves at this depth; the last ply is counted without being played.
std::uint64_t perft(const Rules& rules, const Position& position, int depth);

}  // namespace counterpart
