#include "game_controller/training/self_play.hpp"

#include <cstdlib>

#include "game_controller/engine/dice.hpp"
#include "game_controller/engine/endgame.hpp"
#include "game_controller/engine/search.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/record.hpp"

namespace counterpart {
namespace {

constexpr std::size_t self_play_table_bytes = std::size_t{1} << 20;
constexpr int surely_decided = win_value - 500;
constexpr int as_good_as_decided = 5 * man_value;  // if it lasts
constexpr int so_long_decided_plies = 6;
constexpr int longest_self_play_plies = 240;
constexpr int unfair_start = man_value;
constexpr int patience_with_kings_plies = 12;  // both sides have one: by then what can be won has been won

bool is_quiet(const Position& p) {
  Position swapped = p;
  swapped.turn = other(p.turn);
  return !can_capture(international_rules, p) && !can_capture(international_rules, swapped);
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

float score(int value_for_light) {
  return value_for_light > 0 ? 1.0F : value_for_light < 0 ? 0.0F : 0.5F;
}

// One game from here on; what it teaches is appended. Unfair starts teach nothing.
class Lecture {
 public:
  Lecture(Searcher& searcher, const SelfPlayOptions& options, Dice& dice, std::vector<Lesson>& lessons)
      : searcher_(searcher), options_(options), dice_(dice), lessons_(lessons) {}

  bool play(Record record, int game) {
    const std::size_t first = lessons_.size();
    float result = 0.5F;
    for (int ply = 0; ply < longest_self_play_plies; ++ply) {
      if (const auto ending = record.ending()) {
        result = score(ending->result);
        break;
      }
      const Position& p = record.position();
      std::vector<std::uint64_t> earlier = record.keys();
      earlier.pop_back();
      const SearchReport report = search(p, earlier, options_.depth);
      const int value = for_light(p, report.value);
      if (ply == 0 && std::abs(value) > unfair_start) return false;
      if (const auto decided = decided_result(p, value)) {
        result = *decided;
        break;
      }
      if (is_quiet(p)) lessons_.push_back({p, 0.5F, static_cast<float>(value) / man_value, game});
      teach_beside(p, game);
      record.play(report.line.front());
    }
    for (std::size_t i = first; i < lessons_.size(); ++i) {
      if (lessons_[i].result) lessons_[i].result = result;
    }
    return true;
  }

 private:
  SearchReport search(const Position& p, const std::vector<std::uint64_t>& earlier, int depth) {
    SearchLimits limits;
    limits.depth = depth;
    return searcher_.search(p, earlier, limits);
  }

  static int for_light(const Position& p, int value) { return p.turn == Side::light ? value : -value; }

  // Most of what a search evaluates lies beside the course of good play: some of it must be learnt, too.
  void teach_beside(const Position& p, int game) {
    MoveList moves;
    generate(international_rules, p, moves);
    const Position q = after(international_rules, p, moves[dice_.roll(moves.size())]);
    if (!is_quiet(q) || !has_move(international_rules, q)) return;
    const int value = for_light(q, search(q, {}, options_.depth - 1).value);
    lessons_.push_back({q, std::nullopt, static_cast<float>(value) / man_value, game});
  }

  std::optional<float> decided_result(const Position& p, int value) {
    if (std::abs(value) > surely_decided) return score(value);
    if (options_.endgames != nullptr) {
      if (const auto known = options_.endgames->find(p)) return score(for_light(p, known->outcome));
    }
    const Bits weaker = value > 0 ? p.dark : p.light;
    const bool decided = std::abs(value) >= as_good_as_decided && (weaker & p.kings) == 0;
    decided_plies_ = decided ? decided_plies_ + 1 : 0;
    if (decided_plies_ >= so_long_decided_plies) return score(value);
    if ((p.light & p.kings) != 0 && (p.dark & p.kings) != 0 && ++with_kings_plies_ > patience_with_kings_plies) {
      return 0.5F;
    }
    return std::nullopt;
  }

  Searcher& searcher_;
  const SelfPlayOptions& options_;
  Dice& dice_;
  std::vector<Lesson>& lessons_;
  int decided_plies_ = 0;
  int with_kings_plies_ = 0;
};

}  // namespace

std::vector<Lesson> play_lessons(const SelfPlayOptions& options) {
  std::vector<Lesson> lessons;
  Searcher searcher(international_rules, options.evaluation, self_play_table_bytes, options.weights);
  searcher.use_endgames(options.endgames);
  for (int game = options.first_game; game < options.first_game + options.games; ++game) {
    Dice dice(mixed(mixed(options.seed) + static_cast<std::uint64_t>(game)));
    bool played = false;
    while (!played) {
      const int range = options.most_random_plies - options.fewest_random_plies + 1;
      const auto start = random_start(dice, options.fewest_random_plies + dice.roll(range));
      searcher.clear();
      played = start && Lecture(searcher, options, dice, lessons).play(*start, game);
    }
  }
  return lessons;
}

}  // namespace counterpart
