// What a quiet position is worth, in hundredths of a man, for the side to move.
#pragma once

#include <optional>
#include <string_view>

#include "game_controller/engine/patterns.hpp"
#include "game_controller/rules/position.hpp"
#include "game_controller/rules/rules.hpp"

namespace counterpart {

enum class Evaluation : std::uint8_t {
  material = 1,  // men and kings only
  plain = 2,     // and what players look at: tempo, centre, balance, back row, mobility
  trained = 3,   // patterns of men with weights learnt from games; plain where there are no weights (8x8)
};

// "material", "plain", "trained".
std::string_view name_of(Evaluation evaluation);
std::optional<Evaluation> find_evaluation(std::string_view name);

inline constexpr int man_value = 100;
inline constexpr int win_value = 10'000;  // minus the plies to the end

int king_value(const Rules& rules);

// weights: of the trained evaluation; nullptr: the built-in ones.
int evaluate(const Rules& rules, Evaluation evaluation, const PatternWeights* weights, const Position& position);

}  // namespace counterpart
