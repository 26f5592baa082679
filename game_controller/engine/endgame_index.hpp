// Which byte of an endgame table is which position: pieces of a kind are a combination, so that no two bytes are the
// same position.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "game_controller/engine/endgame.hpp"

namespace counterpart {

class EndgameIndex {
 public:
  explicit EndgameIndex(const Rules& rules);

  std::size_t positions_of(const Material& material) const;

  // Light to move.
  std::size_t of(const Position& position) const;

  // Empty where pieces would stand on each other, or men where they would have been crowned.
  std::optional<Position> position_at(const Material& material, std::size_t index) const;

  // The same from the other side: board turned round, colours swapped, the other to move.
  Position turned(const Position& position) const;
  Position with_light_to_move(const Position& position) const {
    return position.turn == Side::light ? position : turned(position);
  }

 private:
  static constexpr int most_of_a_kind = 3;

  std::size_t rank(Bits pieces) const;
  Bits turned(Bits bits) const;

  int squares_a_side_;
  int last_bit_;
  Bits top_;
  Bits bottom_;
  std::array<int, 64> square_;                                           // from 0, by bit
  std::array<std::array<std::uint32_t, most_of_a_kind + 1>, 64> below_;  // choices of k squares before a square
  std::array<std::vector<Bits>, most_of_a_kind + 1> sets_;               // of so many squares, by rank
};

}  // namespace counterpart
