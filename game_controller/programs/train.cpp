#include "game_controller/programs/train.hpp"

#include <algorithm>
#include <memory>
#include <ostream>

#include "game_controller/training/fit.hpp"
#include "game_controller/training/self_play.hpp"
#include "game_controller/training/weights_file.hpp"

namespace counterpart {

Result<void> train(const TrainOptions& options, std::ostream& log) {
  auto weights = std::make_unique<PatternWeights>();
  bool knows = false;  // without weights the first round is played with the plain evaluation
  if (!options.start.empty()) {
    auto start = read_weights(options.start);
    if (!start) return tl::make_unexpected(start.error());
    *weights = **start;
    knows = true;
  }
  std::vector<Lesson> lessons;
  for (std::size_t round = 0; round < options.games.size(); ++round) {
    SelfPlayOptions play;
    play.games = options.games[round];
    play.depth = options.depth;
    play.seed = options.seed + round;
    play.evaluation = knows ? Evaluation::trained : Evaluation::plain;
    play.weights = weights.get();
    std::vector<Lesson> fresh = play_lessons(play, [&](int games, std::size_t count) {
      if (games % 1000 == 0) {
        log << "round " << round + 1 << ": " << games << " games, " << count << " positions" << std::endl;
      }
    });
    const int games_before = lessons.empty() ? 0 : lessons.back().game + 1;
    for (Lesson& lesson : fresh) lesson.game += games_before;
    lessons.insert(lessons.end(), fresh.begin(), fresh.end());

    FitOptions learn;
    learn.epochs = options.epochs;
    learn.seed = options.seed + round;
    const PatternWeights before = *weights;
    if (!options.start.empty()) learn.start = &before;
    *weights = fit(lessons, learn, [&](const FitProgress& p) {
      log << "round " << round + 1 << ": epoch " << p.epoch << ", loss " << p.loss << ", held back " << p.held_back_loss
          << std::endl;
    });
    knows = true;
    if (auto written = write_weights(*weights, options.out); !written) return written;
  }
  return {};
}

}  // namespace counterpart
