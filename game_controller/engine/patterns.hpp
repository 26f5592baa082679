// A trained evaluation for the 10x10 board: how men stand together in blocks of eight squares, after Scan 2
// (F. Letouzey), who showed how much such patterns tell. Sixteen tall blocks (four rows by two squares) and ten wide
// ones (two rows by four squares) overlap and cover the board; turning the board round and swapping colours makes two
// blocks one, so thirteen sets of weights serve all and the evaluation has no favourite side. What a pattern is worth
// changes as the board empties: two weights, mixed by the number of pieces.
#pragma once

#include <array>
#include <cstdint>

#include "game_controller/rules/position.hpp"

namespace counterpart {

inline constexpr int pattern_count = 13;
inline constexpr int half_pattern_states = 81;  // four squares (two by two), each empty, light man or dark man
inline constexpr int pattern_states = half_pattern_states * half_pattern_states;
inline constexpr int full_stage = 40;  // pieces on the board
inline constexpr int weight_unit = 8;  // weights are in eighths of a hundredth of a man

// What patterns of men do not tell; each counted for light minus for dark.
enum Extra {
  extra_men,
  extra_first_king,
  extra_further_kings,
  extra_steps,      // free squares before men
  extra_imbalance,  // men on one wing more than on the other
  extra_long_diagonal,
  extra_turn,
  extra_count
};

struct StagedWeight {
  std::int16_t opening;  // with a full board
  std::int16_t ending;   // with an empty one
};

struct PatternWeights {
  std::array<std::array<StagedWeight, pattern_states>, pattern_count> patterns;
  std::array<StagedWeight, extra_count> extras;
};

// What the evaluation sees of a position. The first half of the blocks counts for light, the second (the same blocks,
// from dark's side) against it. A state is that of the block's first four squares times 81 plus that of the others.
struct PatternView {
  std::array<std::uint16_t, 2 * pattern_count> states;
  std::array<std::int8_t, extra_count> extras;
  int stage;  // pieces on the board, at most full_stage
};

// 10x10 only.
PatternView view_patterns(const Position& position);

// For light, in hundredths of a man.
int pattern_value(const PatternWeights& weights, const Position& position);

// The weights that come with the program (trained.weights beside this file, see docs/adr).
const PatternWeights& built_in_weights();

}  // namespace counterpart
