#include "game_controller/engine/patterns.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace counterpart {
namespace {

using Board10 = Layout<10>;

constexpr int row_pairs = 5;
constexpr int columns = 4;

// From four bits of light men and four of dark men to a number in base three.
struct PairTables {
  std::array<std::uint8_t, 256> straight{};
  std::array<std::uint8_t, 256> turned{};  // the board turned round, colours swapped

  constexpr PairTables() {
    for (unsigned light = 0; light < 16; ++light) {
      for (unsigned dark = 0; dark < 16; ++dark) {
        int value = 0;
        int turned_value = 0;
        for (unsigned i = 0; i < 4; ++i) {
          value = 3 * value + digit(light, dark, 3 - i);
          turned_value = 3 * turned_value + digit(dark, light, i);
        }
        straight[light | dark << 4] = static_cast<std::uint8_t>(value);
        turned[light | dark << 4] = static_cast<std::uint8_t>(turned_value);
      }
    }
  }

  static constexpr int digit(unsigned mine, unsigned theirs, unsigned bit) {
    return (mine >> bit & 1) != 0 ? 1 : (theirs >> bit & 1) != 0 ? 2 : 0;
  }
};

constexpr PairTables pair_tables;

// Four squares, two in each of two rows: bits 0, 1, 5 and 6 from the corner of the block.
unsigned pair_at(Bits men, int row_pair, int column) {
  const Bits x = men >> (11 * row_pair + column);
  return static_cast<unsigned>((x & 3) | (x >> 3 & 12));
}

constexpr Bits left_wing() {
  Bits bits = 0;
  for (int row = 0; row < 10; ++row) {
    for (int i = 0; i < 2; ++i) bits |= square_mask(5 * row + i + 1, 10);
    if (row % 2 == 1) bits |= square_mask(5 * row + 3, 10);
  }
  return bits;
}

constexpr Bits long_diagonal() {
  Bits bits = 0;
  for (const int square : {5, 10, 14, 19, 23, 28, 32, 37, 41, 46}) bits |= square_mask(square, 10);
  return bits;
}

int imbalance(Bits men) {
  return std::abs(std::popcount(men & left_wing()) - std::popcount(men & ~left_wing()));
}

int steps(Bits one_way, Bits other_way, Bits open) {
  return std::popcount(one_way & open) + std::popcount(other_way & open);
}

}  // namespace

PatternView view_patterns(const Position& p) {
  PatternView view;
  const Bits light = p.light & ~p.kings;
  const Bits dark = p.dark & ~p.kings;
  std::array<std::array<std::uint8_t, columns>, row_pairs> pair;  // base-three numbers; the middle row pair twice
  std::array<std::uint8_t, columns> middle_turned;
  for (int r = 0; r < row_pairs; ++r) {
    for (int c = 0; c < columns; ++c) {
      const unsigned both = pair_at(light, r, c) | pair_at(dark, r, c) << 4;
      const auto& table = r <= 2 ? pair_tables.straight : pair_tables.turned;
      pair[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = table[both];
      if (r == 2) middle_turned[static_cast<std::size_t>(c)] = pair_tables.turned[both];
    }
  }
  const auto state = [](int first, int second) {
    return static_cast<std::uint16_t>(first * half_pattern_states + second);
  };
  for (std::size_t c = 0; c < columns; ++c) {
    const std::size_t d = columns - 1 - c;  // the same column with the board turned round
    view.states[c] = state(pair[0][c], pair[1][c]);
    view.states[columns + c] = state(pair[1][c], pair[2][c]);
    view.states[pattern_count + c] = state(pair[4][d], pair[3][d]);
    view.states[pattern_count + columns + c] = state(pair[3][d], middle_turned[d]);
  }
  constexpr std::size_t first_wide = 2 * columns;
  for (std::size_t r = 0; r < 2; ++r) {
    for (std::size_t c = 0; c < 2; ++c) {
      const std::size_t block = first_wide + 2 * r + c;
      view.states[block] = state(pair[r][c], pair[r][c + 2]);
      view.states[pattern_count + block] = state(pair[4 - r][3 - c], pair[4 - r][1 - c]);
    }
  }
  constexpr std::size_t middle_wide = pattern_count - 1;  // turned round, the left middle block is the right one
  view.states[middle_wide] = state(pair[2][0], pair[2][2]);
  view.states[pattern_count + middle_wide] = state(middle_turned[3], middle_turned[1]);

  const Bits light_kings = p.light & p.kings;
  const Bits dark_kings = p.dark & p.kings;
  const Bits open = Board10::all & ~(p.light | p.dark);
  const auto set = [&](Extra extra, int value) { view.extras[extra] = static_cast<std::int8_t>(value); };
  const int light_king_count = std::popcount(light_kings);
  const int dark_king_count = std::popcount(dark_kings);
  set(extra_men, std::popcount(light) - std::popcount(dark));
  set(extra_first_king, std::min(light_king_count, 1) - std::min(dark_king_count, 1));
  set(extra_further_kings, std::max(light_king_count - 1, 0) - std::max(dark_king_count - 1, 0));
  set(extra_steps, steps(shifted<Board10::up_left>(light), shifted<Board10::up_right>(light), open) -
                       steps(shifted<Board10::down_left>(dark), shifted<Board10::down_right>(dark), open));
  set(extra_imbalance, imbalance(light) - imbalance(dark));
  set(extra_long_diagonal, ((light_kings & long_diagonal()) != 0) - ((dark_kings & long_diagonal()) != 0));
  set(extra_turn, p.turn == Side::light ? 1 : -1);
  view.stage = std::min(std::popcount(p.light | p.dark), full_stage);
  return view;
}

int pattern_value(const PatternWeights& weights, const Position& position) {
  const PatternView view = view_patterns(position);
  int opening = 0;
  int ending = 0;
  for (std::size_t i = 0; i < pattern_count; ++i) {
    const StagedWeight& light = weights.patterns[i][view.states[i]];
    const StagedWeight& dark = weights.patterns[i][view.states[pattern_count + i]];
    opening += light.opening - dark.opening;
    ending += light.ending - dark.ending;
  }
  for (std::size_t i = 0; i < extra_count; ++i) {
    opening += weights.extras[i].opening * view.extras[i];
    ending += weights.extras[i].ending * view.extras[i];
  }
  return (opening * view.stage + ending * (full_stage - view.stage)) / (full_stage * weight_unit);
}

}  // namespace counterpart
