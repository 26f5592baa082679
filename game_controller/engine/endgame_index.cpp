#include "game_controller/engine/endgame_index.hpp"

#include <bit>
#include <utility>

#include "protocol/vocabulary/board_geometry.hpp"

namespace counterpart {

EndgameIndex::EndgameIndex(const Rules& rules)
    : squares_a_side_(rules.squares),
      last_bit_(bit_of_square(playable_squares(rules.squares), rules.squares)),
      top_(row_mask(0, rules.squares)),
      bottom_(row_mask(rules.squares - 1, rules.squares)) {
  const int squares = playable_squares(rules.squares);
  square_.fill(0);
  for (int s = 0; s < squares; ++s) {
    square_[static_cast<std::size_t>(bit_of_square(s + 1, squares_a_side_))] = s;
    auto& below = below_[static_cast<std::size_t>(s)];
    const auto n = static_cast<std::uint32_t>(s);
    below = {1, n, n > 0 ? n * (n - 1) / 2 : 0, n > 1 ? n * (n - 1) * (n - 2) / 6 : 0};
  }
  sets_[0] = {0};
  for (int k = 1; k <= most_of_a_kind; ++k) {
    auto& sets = sets_[static_cast<std::size_t>(k)];
    for (int highest = k - 1; highest < squares; ++highest) {
      const auto& smaller = sets_[static_cast<std::size_t>(k - 1)];
      const std::size_t count = below_[static_cast<std::size_t>(highest)][static_cast<std::size_t>(k - 1)];
      for (std::size_t i = 0; i < count; ++i) {
        sets.push_back(smaller[i] | square_mask(highest + 1, squares_a_side_));
      }
    }
  }
}

std::size_t EndgameIndex::positions_of(const Material& m) const {
  const auto ways = [&](int n) { return sets_[static_cast<std::size_t>(n)].size(); };
  return ways(m.light_men) * ways(m.light_kings) * ways(m.dark_men) * ways(m.dark_kings);
}

std::size_t EndgameIndex::rank(Bits pieces) const {
  std::size_t sum = 0;
  for (std::size_t k = 1; pieces != 0; pieces &= pieces - 1, ++k) {
    sum += below_[static_cast<std::size_t>(square_[static_cast<std::size_t>(lowest(pieces))])][k];
  }
  return sum;
}

std::size_t EndgameIndex::of(const Position& p) const {
  std::size_t index = rank(p.light & ~p.kings);
  for (const Bits pieces : {p.light & p.kings, p.dark & ~p.kings, p.dark & p.kings}) {
    index = index * sets_[static_cast<std::size_t>(std::popcount(pieces))].size() + rank(pieces);
  }
  return index;
}

std::optional<Position> EndgameIndex::position_at(const Material& m, std::size_t index) const {
  const auto take = [&](int n) {
    const auto& sets = sets_[static_cast<std::size_t>(n)];
    const Bits pieces = sets[index % sets.size()];
    index /= sets.size();
    return pieces;
  };
  const Bits dark_kings = take(m.dark_kings);
  const Bits dark_men = take(m.dark_men);
  const Bits light_kings = take(m.light_kings);
  const Bits light_men = take(m.light_men);
  const Bits all = dark_kings | dark_men | light_kings | light_men;
  if (std::popcount(all) != m.pieces() || (light_men & top_) != 0 || (dark_men & bottom_) != 0) return std::nullopt;
  return Position{light_men | light_kings, dark_men | dark_kings, light_kings | dark_kings, Side::light};
}

Bits EndgameIndex::turned(Bits bits) const {
  Bits out = 0;
  for (; bits != 0; bits &= bits - 1) out |= one(last_bit_ - lowest(bits));
  return out;
}

Position EndgameIndex::turned(const Position& p) const {
  return {turned(p.dark), turned(p.light), turned(p.kings), other(p.turn)};
}

}  // namespace counterpart
