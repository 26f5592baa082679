// Games of the engine against itself, as lessons: quiet positions with how the game ended and what the search thought.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "game_controller/engine/evaluate.hpp"
#include "game_controller/engine/patterns.hpp"
#include "game_controller/rules/position.hpp"

namespace counterpart {

struct Lesson {
  Position position;   // neither side can capture
  float result = 0.5;  // of the game, for light: 0, 0.5 or 1
  float value = 0;     // of the search, for light, in men
  int game = 0;
};

struct SelfPlayOptions {
  int games = 1000;
  int depth = 3;
  int random_plies = 10;  // half as many to so many start each game, so that no two are alike
  std::uint64_t seed = 1;
  Evaluation evaluation = Evaluation::plain;
  const PatternWeights* weights = nullptr;  // of the trained evaluation; nullptr: the built-in ones
};

// International rules. The same options give the same lessons.
std::vector<Lesson> play_lessons(const SelfPlayOptions& options,
                                 const std::function<void(int games, std::size_t lessons)>& on_progress = {});

}  // namespace counterpart
