#include "game_controller/programs/train.hpp"

#include <algorithm>
#include <memory>
#include <ostream>

#include "game_controller/engine/endgame_cache.hpp"
#include "game_controller/training/fit.hpp"
#include "game_controller/training/lessons_file.hpp"
#include "game_controller/training/self_play.hpp"
#include "game_controller/training/weights_file.hpp"
#include "protocol/daemon/stop_signal.hpp"

namespace counterpart {
namespace {

constexpr int games_a_part = 100;  // no more are lost when it is stopped

}  // namespace

Result<void> play_lessons_to_file(const LessonOptions& options, std::ostream& log) {
  catch_stop_signals();
  SelfPlayOptions play;
  std::unique_ptr<PatternWeights> weights;
  play.evaluation = options.weights == "plain" ? Evaluation::plain : Evaluation::trained;
  if (!options.weights.empty() && options.weights != "plain") {
    auto read = read_weights(options.weights);
    if (!read) return tl::make_unexpected(read.error());
    weights = std::move(*read);
    play.weights = weights.get();
  }
  const auto there = read_lessons(options.out);
  if (!there && there.error().code != ErrorCode::not_found) return tl::make_unexpected(there.error());
  play.first_game = there && !there->empty() ? there->back().game + 1 : 0;
  EndgameCache endgames(international_rules);
  endgames.make_all(EndgameTables::most_pieces, stop_requested);
  play.endgames = &endgames.tables();
  play.depth = options.depth;
  play.seed = options.seed;
  while (play.first_game < options.games && !stop_requested()) {
    play.games = std::min(games_a_part, options.games - play.first_game);
    if (auto written = append_lessons(play_lessons(play), options.out); !written) return written;
    play.first_game += play.games;
    if (play.first_game % 1000 == 0) log << play.first_game << " of " << options.games << " games" << std::endl;
  }
  return {};
}

Result<void> fit_files(const FitFilesOptions& options, std::ostream& log) {
  FitOptions learn;
  learn.epochs = options.epochs;
  learn.trust_in_search = options.trust_in_search;
  std::unique_ptr<PatternWeights> start;
  if (!options.start.empty()) {
    auto read = read_weights(options.start);
    if (!read) return tl::make_unexpected(read.error());
    start = std::move(*read);
    learn.start = start.get();
  }
  std::vector<Lesson> lessons;
  int games = 0;
  for (const std::string& file : options.lessons) {
    auto read = read_lessons(file);
    if (!read) return tl::make_unexpected(read.error());
    for (Lesson& lesson : *read) lesson.game += games;
    lessons.insert(lessons.end(), read->begin(), read->end());
    if (!lessons.empty()) games = lessons.back().game + 1;
  }
  log << lessons.size() << " lessons of " << games << " games" << std::endl;
  const PatternWeights weights = fit(lessons, learn, [&](const FitProgress& p) {
    log << "epoch " << p.epoch << ": loss " << p.loss << ", held back " << p.held_back_loss << std::endl;
  });
  return write_weights(weights, options.out);
}

}  // namespace counterpart
