// Games of the engine against itself, as lessons: quiet positions with how the game ended and what the search thought.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "game_controller/engine/evaluate.hpp"
#include "game_controller/engine/patterns.hpp"
#include "game_controller/rules/position.hpp"

namespace counterpart {

class EndgameTables;

struct Lesson {
  Position position;            // neither side can capture
  std::optional<float> result;  // of the game, for light: 0, 0.5 or 1; empty for a position beside the game's course
  float value = 0;              // of the search, for light, in men
  int game = 0;
};

struct SelfPlayOptions {
  int first_game = 0;  // a game's number decides how it begins and goes, so that a series can be played in parts
  int games = 1000;
  int depth = 4;
  int fewest_random_plies = 4;  // so many to
  int most_random_plies = 14;   // so many start each game, so that no two are alike
  std::uint64_t seed = 1;
  Evaluation evaluation = Evaluation::plain;
  const PatternWeights* weights = nullptr;  // of the trained evaluation; nullptr: the built-in ones
  const EndgameTables* endgames = nullptr;  // what they know is not played out; nullptr: everything is
};

// International rules. The same options give the same lessons.
std::vector<Lesson> play_lessons(const SelfPlayOptions& options);

}  // namespace counterpart
