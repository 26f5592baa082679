#include "game_controller/training/self_play.hpp"

#include <bit>
#include <optional>

#include "game_controller/engine/dice.hpp"
#include "game_controller/engine/search.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/record.hpp"

namespace counterpart {
namespace {

constexpr std::size_t self_play_table_bytes = std::size_t{1} << 20;
constexpr int surely_decided = win_value - 500;
constexpr int longest_self_play_plies = 240;
constexpr int unfair_start = man_value;
constexpr int patience_with_kings_plies = 12;  // both sides have one: by then what can be won has been won

bool can_capture_at_all(const Position& p) {
  Position swapped = p;
  swapped.turn = other(p.turn);
  return can_capture(international_rules, p) || can_capture(international_rules, swapped);
}

std::optional<Record> random_start(Dice& dice, int plies) {
  Record record(international_rules, start_position(international_rules));
  for (int i = 0; i < plies; ++i) {
    MoveList moves;
    generate(international_rules, record.position(), moves);
    if (moves.empty()) return std::nullopt;
    record.play(moves[dice.roll(moves.size())]);
  }
  if (record.ending()) return std::nullopt;
  return record;
}

float score(GameResult result) {
  return result == GameResult::light_wins ? 1.0F : result == GameResult::dark_wins ? 0.0F : 0.5F;
}

// One game from here on; what it teaches is appended. Empty starts and unfair ones teach nothing.
class Lecture {
 public:
  Lecture(Searcher& searcher, int depth, std::vector<Lesson>& lessons)
      : searcher_(searcher), depth_(depth), lessons_(lessons) {}

  bool play(Record record, int game) {
    const std::size_t first = lessons_.size();
    float result = 0.5F;
    int with_kings = 0;
    for (int ply = 0; ply < longest_self_play_plies; ++ply) {
      if (const auto ending = record.ending()) {
        result = score(ending->result);
        break;
      }
      std::vector<std::uint64_t> earlier = record.keys();
      earlier.pop_back();
      SearchLimits limits;
      limits.depth = depth_;
      const SearchReport report = searcher_.search(record.position(), earlier, limits);
      const Position& p = record.position();
      const int value = p.turn == Side::light ? report.value : -report.value;
      if (ply == 0 && std::abs(value) > unfair_start) return false;
      if (std::abs(value) > surely_decided) {
        result = value > 0 ? 1.0F : 0.0F;
        break;
      }
      if ((p.light & p.kings) != 0 && (p.dark & p.kings) != 0 && ++with_kings > patience_with_kings_plies) break;
      if (!can_capture_at_all(p)) {
        lessons_.push_back({p, 0.5F, static_cast<float>(value) / man_value, game});
      }
      record.play(report.line.front());
    }
    for (std::size_t i = first; i < lessons_.size(); ++i) lessons_[i].result = result;
    return true;
  }

 private:
  Searcher& searcher_;
  int depth_;
  std::vector<Lesson>& lessons_;
};

}  // namespace

std::vector<Lesson> play_lessons(const SelfPlayOptions& options,
                                 const std::function<void(int, std::size_t)>& on_progress) {
  std::vector<Lesson> lessons;
  Dice dice(options.seed);
  Searcher searcher(international_rules, options.evaluation, self_play_table_bytes, options.weights);
  for (int game = 0; game < options.games;) {
    const int fewest = options.random_plies / 2;
    const auto start = random_start(dice, fewest + dice.roll(options.random_plies - fewest + 1));
    if (!start) continue;
    searcher.clear();
    if (!Lecture(searcher, options.depth, lessons).play(*start, game)) continue;
    ++game;
    if (on_progress && game % 100 == 0) on_progress(game, lessons.size());
  }
  return lessons;
}

}  // namespace counterpart
