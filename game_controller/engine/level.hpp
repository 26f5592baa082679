// Eight opponents for everyone: how deep each looks, what it understands, and how freely it chooses among moves that it
// thinks nearly equal. Weaker levels see less; none throws away a game that it has understood.
#pragma once

#include <cstdint>

#include "game_controller/engine/search.hpp"

namespace counterpart {

struct LevelPlan {
  Evaluation evaluation = Evaluation::plain;
  int depth = 1;
  std::uint64_t nodes = 0;  // 0: the whole depth is always searched
  int margin = 0;           // moves within so many hundredths of a man of the best are all candidates
};

constexpr int lowest_level = 1;
constexpr int highest_level = 8;

// level outside 1..8 is taken as the nearest of them.
LevelPlan plan_of_level(int level);

struct Choice {
  ScoredMove best;
  std::vector<Move> line;
  std::uint64_t nodes = 0;
};

// The move that a player of this level makes here; the same for the same seed and position. There must be a legal move.
Choice choose(Searcher& searcher, const Rules& rules, const Position& position,
              const std::vector<std::uint64_t>& earlier, const LevelPlan& plan, std::uint64_t seed,
              const std::function<bool()>& give_up = {});

// How long a person would seem to think: a forced recapture is quick, a choice among near-equal moves slow. Seconds.
double acted_thinking_s(const Rules& rules, const Position& position);

}  // namespace counterpart
