// What a quiet position is worth, in hundredths of a man, for the side to move.
#pragma once

#include "game_controller/rules/position.hpp"
#include "game_controller/rules/rules.hpp"

namespace counterpart {

enum class Evaluation : std::uint8_t {
  material = 1,  // men and kings only
  plain = 2,     // and what players look at: tempo, centre, balance, back row, mobility
};

inline constexpr int man_value = 100;
inline constexpr int win_value = 10'000;  // minus the plies to the end

int king_value(const Rules& rules);

int evaluate(const Rules& rules, Evaluation evaluation, const Position& position);

}  // namespace counterpart
