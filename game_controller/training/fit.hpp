// Weights from lessons: logistic regression by gradient steps (AdaGrad), each weight in men.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "game_controller/engine/patterns.hpp"
#include "game_controller/training/self_play.hpp"

namespace counterpart {

struct FitOptions {
  int epochs = 4;
  double trust_in_search = 0.75;  // share of the search's value in what is learnt; the rest is the result of the game
  double step = 0.05;
  double shrink = 2e-5;    // pull towards 0 at each visit: rare patterns stay small
  int held_back = 20;      // every so many games one is not learnt but only predicted, to see what was understood
  std::uint64_t seed = 1;  // of the order of the lessons
  const PatternWeights* start = nullptr;  // what is known already; nullptr: only what pieces are worth
};

struct FitProgress {
  int epoch = 0;
  double loss = 0;            // mean logistic loss of what was learnt
  double held_back_loss = 0;  // of what was not
};

PatternWeights fit(const std::vector<Lesson>& lessons, const FitOptions& options,
                   const std::function<void(const FitProgress&)>& on_epoch = {});

}  // namespace counterpart
