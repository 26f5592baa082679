// Endgame tables: for every position of two or three pieces on the 10x10 board, who wins and how soon. Made by working
// back from the ends (retrograde analysis); the draw rules that count moves are left out.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "game_controller/rules/position.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct EndgameValue {
  int outcome = 0;  // for the side to move: 1 wins, -1 loses, 0 neither
  int plies = 0;    // to the end with best play of both; 0 if neither wins
};

class EndgameTables {
 public:
  static constexpr int most_pieces = 3;

  // Takes seconds; always gives the same.
  static EndgameTables generate();

  [[nodiscard]] static Result<EndgameTables> load(const std::string& file);
  [[nodiscard]] Result<void> save(const std::string& file) const;

  // From the cache ($COUNTERPART_CACHE or ~/.cache/counterpart, in the folder endgames); made and put there if they are
  // not in it yet. A cache that cannot be written does no harm.
  static EndgameTables load_or_generate();

  // Empty if there are more pieces, or a side has none.
  std::optional<EndgameValue> find(const Position& position) const;

 private:
  // Light to move always: the board is turned round for dark. One byte a position: 0 no win, else plies + 1, where the
  // side to move has lost if the plies are even. A class is a number of men and kings of each side.
  static constexpr std::size_t classes = 256;
  std::array<std::vector<std::uint8_t>, classes> tables_;
};

}  // namespace counterpart
