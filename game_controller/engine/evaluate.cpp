#include "game_controller/engine/evaluate.hpp"

#include <array>
#include <bit>
#include <cstdlib>

#include "protocol/vocabulary/board_geometry.hpp"

namespace counterpart {
namespace {

// What a light man on a square is worth beyond its material, by bit. For dark men the board is turned round.
template <int N>
struct ManTable {
  std::array<int, 64> light{};
  std::array<int, 64> dark{};

  constexpr ManTable() {
    for (int square = 1; square <= playable_squares(N); ++square) {
      const Cell cell = cell_of_square(square, N);
      const int advance = N - 1 - cell.row;
      const int from_edge = cell.col < N / 2 ? cell.col : N - 1 - cell.col;
      int value = advance + 2 * (from_edge > 2 ? 2 : from_edge);
      if (cell.row == N - 1) value += cell.col == N / 2 || cell.col == N / 2 - 2 ? 6 : 2;  // guards of the back row
      light[static_cast<std::size_t>(bit_of_square(square, N))] = value;
      dark[static_cast<std::size_t>(bit_of_square(playable_squares(N) + 1 - square, N))] = value;
    }
  }
};

template <int N>
constexpr ManTable<N> man_table{};

template <int N>
constexpr Bits left_half() {
  Bits bits = 0;
  for (int square = 1; square <= playable_squares(N); ++square) {
    if (cell_of_square(square, N).col < N / 2) bits |= square_mask(square, N);
  }
  return bits;
}

int table_sum(Bits men, const std::array<int, 64>& table) {
  int sum = 0;
  for (; men != 0; men &= men - 1) sum += table[static_cast<std::size_t>(lowest(men))];
  return sum;
}

int imbalance(Bits men, Bits left) {
  return std::abs(std::popcount(men & left) - std::popcount(men & ~left));
}

// For light. Balance: men that are all on one wing are easily held. Locks: a side that has few free steps is soon
// forced.
template <int N>
int positional(const Position& p) {
  using L = Layout<N>;
  const Bits light = p.light & ~p.kings;
  const Bits dark = p.dark & ~p.kings;
  const Bits open = L::all & ~(p.light | p.dark);
  int value = table_sum(light, man_table<N>.light) - table_sum(dark, man_table<N>.dark);
  value -= 2 * (imbalance(light, left_half<N>()) - imbalance(dark, left_half<N>()));
  const int light_steps =
      std::popcount(shifted<L::up_left>(light) & open) + std::popcount(shifted<L::up_right>(light) & open);
  const int dark_steps =
      std::popcount(shifted<L::down_left>(dark) & open) + std::popcount(shifted<L::down_right>(dark) & open);
  value += 2 * (light_steps - dark_steps);
  return value;
}

int material(const Rules& rules, const Position& p) {
  const int men = std::popcount(p.light & ~p.kings) - std::popcount(p.dark & ~p.kings);
  const int kings = std::popcount(p.light & p.kings) - std::popcount(p.dark & p.kings);
  return men * man_value + kings * king_value(rules);
}

// A weaker side that has a king is rarely beaten by three pieces or fewer (with flying kings).
bool is_drawish(const Rules& rules, const Position& p, int value_for_light) {
  const Bits strong = value_for_light > 0 ? p.light : p.dark;
  const Bits weak = value_for_light > 0 ? p.dark : p.light;
  return rules.flying_kings && (weak & p.kings) != 0 && std::popcount(strong) <= 3;
}

}  // namespace

std::string_view name_of(Evaluation evaluation) {
  return evaluation == Evaluation::material ? "material" : evaluation == Evaluation::plain ? "plain" : "trained";
}

std::optional<Evaluation> find_evaluation(std::string_view name) {
  for (const auto evaluation : {Evaluation::material, Evaluation::plain, Evaluation::trained}) {
    if (name == name_of(evaluation)) return evaluation;
  }
  return std::nullopt;
}

int king_value(const Rules& rules) {
  return rules.flying_kings ? 300 : 130;
}

int evaluate(const Rules& rules, Evaluation evaluation, const PatternWeights* weights, const Position& position) {
  int value = 0;
  if (evaluation == Evaluation::trained && rules.id == RulesId::international) {
    value = pattern_value(weights != nullptr ? *weights : built_in_weights(), position);
  } else {
    value = material(rules, position);
    if (evaluation != Evaluation::material) {
      value += rules.squares == 10 ? positional<10>(position) : positional<8>(position);
    }
  }
  if (is_drawish(rules, position, value)) value /= 8;
  return position.turn == Side::light ? value : -value;
}

}  // namespace counterpart
