#include "game_controller/engine/level.hpp"

#include <algorithm>
#include <array>

#include "game_controller/engine/dice.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

constexpr std::array<LevelPlan, highest_level> plans{{
    {Evaluation::material, 1, 0, 60},
    {Evaluation::material, 2, 0, 30},
    {Evaluation::plain, 3, 0, 12},
    {Evaluation::plain, 4, 0, 0},
    {Evaluation::trained, 60, 4'000, 0},
    {Evaluation::trained, 60, 20'000, 0},
    {Evaluation::trained, 60, 120'000, 0},
    {Evaluation::trained, 60, 1'000'000, 0},
}};

}  // namespace

LevelPlan plan_of_level(int level) {
  return plans[static_cast<std::size_t>(std::clamp(level, lowest_level, highest_level) - 1)];
}

Choice choose(Searcher& searcher, const Rules& rules, const Position& position,
              const std::vector<std::uint64_t>& earlier, const LevelPlan& plan, std::uint64_t seed,
              const std::function<bool()>& give_up) {
  MoveList legal;
  generate(rules, position, legal);
  if (legal.size() == 1) return {{legal[0], 0}, {legal[0]}};
  if (plan.margin > 0) {
    const auto ranked = searcher.rank(position, earlier, plan.depth);
    const auto near = std::count_if(ranked.begin(), ranked.end(),
                                    [&](const ScoredMove& m) { return m.value >= ranked.front().value - plan.margin; });
    const auto pick = mixed(seed ^ key_of(position)) % static_cast<std::uint64_t>(near);
    const ScoredMove& chosen = ranked[static_cast<std::size_t>(pick)];
    return {chosen, {chosen.move}};
  }
  SearchLimits limits;
  limits.depth = plan.depth;
  limits.nodes = plan.nodes;
  limits.give_up = give_up;
  const SearchReport report = searcher.search(position, earlier, limits);
  return {{report.line.front(), report.value}, report.line, report.nodes};
}

double acted_thinking_s(const Rules& rules, const Position& position) {
  MoveList legal;
  generate(rules, position, legal);
  if (legal.size() <= 1) return 0.6;
  const auto ranked = Searcher(rules, Evaluation::plain, 1 << 12).rank(position, {}, 2);
  const auto near = std::count_if(ranked.begin(), ranked.end(),
                                  [&](const ScoredMove& m) { return m.value >= ranked.front().value - 10; });
  return std::min(1.2 + 0.5 * static_cast<double>(near), 5.0);
}

}  // namespace counterpart
