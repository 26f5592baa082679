#include "game_controller/programs/arena.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <ostream>

#include <nlohmann/json.hpp>

#include "game_controller/engine/dice.hpp"
#include "game_controller/engine/level.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/record.hpp"
#include "game_controller/training/weights_file.hpp"

namespace counterpart {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t arena_table_bytes = std::size_t{16} << 20;
constexpr std::size_t longest_arena_game_plies = 300;

class Contestant {
 public:
  static Result<std::unique_ptr<Contestant>> make(const std::string& name, const ArenaOptions& options) {
    auto contestant = std::make_unique<Contestant>();
    const std::uint64_t nodes = options.move_time_s > 0 ? 0 : options.nodes;
    contestant->move_time_s_ = options.move_time_s;
    LevelPlan& plan = contestant->plan_;
    const auto evaluation = find_evaluation(name);
    if (name.size() == 7 && name.rfind("level:", 0) == 0 && name[6] >= '1' && name[6] <= '8') {
      plan = plan_of_level(name[6] - '0');
      contestant->move_time_s_ = 0;
    } else if (evaluation) {
      plan = {*evaluation, 60, nodes, 0};
    } else if (name.rfind("weights:", 0) == 0) {
      auto weights = read_weights(name.substr(8));
      if (!weights) return tl::make_unexpected(weights.error());
      contestant->weights_ = std::move(*weights);
      plan = {Evaluation::trained, 60, nodes, 0};
    } else {
      return failure(ErrorCode::invalid_argument, "There is no player \"" + name +
                                                      "\"; use level:1 to level:8, trained, plain, material or " +
                                                      "weights:FILE.");
    }
    contestant->searcher_ =
        std::make_unique<Searcher>(international_rules, plan.evaluation, arena_table_bytes, contestant->weights_.get());
    return contestant;
  }

  void new_game(std::uint64_t seed) {
    searcher_->clear();
    seed_ = seed;
  }

  Move move(const Record& record) {
    std::vector<std::uint64_t> earlier = record.keys();
    earlier.pop_back();
    const auto start = Clock::now();
    const auto elapsed_s = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    std::function<bool()> out_of_time;
    if (move_time_s_ > 0) out_of_time = [&] { return elapsed_s() >= move_time_s_; };
    const Choice choice =
        choose(*searcher_, international_rules, record.position(), earlier, plan_, seed_, out_of_time);
    thought_s_ += elapsed_s();
    nodes_ += choice.nodes;
    return choice.best.move;
  }

  double nodes_a_second() const { return thought_s_ > 0 ? static_cast<double>(nodes_) / thought_s_ : 0; }

 private:
  LevelPlan plan_;
  std::unique_ptr<PatternWeights> weights_;
  std::unique_ptr<Searcher> searcher_;
  std::uint64_t seed_ = 1;
  double move_time_s_ = 0;  // 0: no limit but the plan's
  double thought_s_ = 0;
  std::uint64_t nodes_ = 0;
};

Record start_of(std::uint64_t seed, int plies) {
  Dice dice(seed);
  Record record(international_rules, start_position(international_rules));
  for (int i = 0; i < plies; ++i) {
    MoveList moves;
    generate(international_rules, record.position(), moves);
    if (moves.empty()) break;
    record.play(moves[dice.roll(moves.size())]);
  }
  return record;
}

GameResult play(Record record, Contestant& light, Contestant& dark) {
  while (record.moves().size() < longest_arena_game_plies) {
    if (const auto ending = record.ending()) return ending->result;
    record.play((record.position().turn == Side::light ? light : dark).move(record));
  }
  return GameResult::draw;
}

}  // namespace

Result<void> run_arena(const ArenaOptions& options, std::ostream& out, std::ostream& log) {
  auto a = Contestant::make(options.a, options);
  if (!a) return tl::make_unexpected(a.error());
  auto b = Contestant::make(options.b, options);
  if (!b) return tl::make_unexpected(b.error());
  int wins = 0;
  int draws = 0;
  int losses = 0;
  for (int game = 0; game < options.games; ++game) {
    const auto opening = static_cast<std::uint64_t>(game / 2);
    const bool a_is_light = game % 2 == 0;
    (*a)->new_game(mixed(options.seed + opening) + 1);
    (*b)->new_game(mixed(options.seed + opening) + 2);
    const Record start = start_of(mixed(options.seed + opening), options.random_plies);
    const GameResult result = a_is_light ? play(start, **a, **b) : play(start, **b, **a);
    if (result == GameResult::draw) {
      ++draws;
    } else if ((result == GameResult::light_wins) == a_is_light) {
      ++wins;
    } else {
      ++losses;
    }
    if ((game + 1) % 10 == 0) log << game + 1 << " games: +" << wins << " =" << draws << " -" << losses << std::endl;
  }
  nlohmann::ordered_json report;
  report["a"] = options.a;
  report["b"] = options.b;
  report["games"] = options.games;
  report["wins"] = wins;
  report["draws"] = draws;
  report["losses"] = losses;
  report["score"] = options.games == 0 ? 0.5 : (wins + 0.5 * draws) / options.games;
  if (options.move_time_s > 0) report["move_time_s"] = options.move_time_s;
  report["a_nodes_a_second"] = static_cast<std::uint64_t>((*a)->nodes_a_second());
  report["b_nodes_a_second"] = static_cast<std::uint64_t>((*b)->nodes_a_second());
  out << report.dump() << std::endl;
  return {};
}

}  // namespace counterpart
