// The course of a game: moves, positions and when it is over.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "game_controller/rules/move.hpp"
#include "game_controller/rules/position.hpp"
#include "game_controller/rules/rules.hpp"

namespace counterpart {

struct Ending {
  GameResult result = GameResult::open;
  const char* code = "";  // "no_moves", "repetition", "kings_only", "lone_king"
};

// Moves that each side still has from when such a material came about, 0 if neither side is a lone king (FMJD Annex 1
// art. 6.3 and 6.4).
int lone_king_limit(const Rules& rules, const Position& position);

class Record {
 public:
  Record(const Rules& rules, const Position& start);

  // The move must be legal here.
  void play(const Move& move);

  // Takes back the last move; nothing at the start.
  void undo();

  const Rules& rules() const { return *rules_; }
  const Position& start() const { return steps_.front().position; }
  const Position& position() const { return steps_.back().position; }
  const std::vector<Move>& moves() const { return moves_; }
  const Position& position_before(std::size_t ply) const { return steps_[ply].position; }

  // Keys of all positions so far, the present one last.
  std::vector<std::uint64_t> keys() const;

  // Empty while the game goes on (FMJD Annex 1 art. 6 and 7).
  std::optional<Ending> ending() const;

 private:
  struct Step {
    Position position;
    std::uint64_t key = 0;
    int kings_only_plies = 0;
    int lone_king_limit = 0;  // moves each; 0: no lone king on the board
    int lone_king_plies = 0;
  };

  const Rules* rules_;
  std::vector<Step> steps_;
  std::vector<Move> moves_;
};

}  // namespace counterpart
