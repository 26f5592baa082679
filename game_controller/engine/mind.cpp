#include "game_controller/engine/mind.hpp"

#include "game_controller/engine/level.hpp"
#include "game_controller/links/hub_client.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

constexpr std::size_t own_mind_table_bytes = std::size_t{32} << 20;
constexpr std::size_t lockstep_table_bytes = std::size_t{4} << 20;  // cleared before each move, so small

Result<Position> playable(const Rules& rules, const std::string& fen) {
  const auto position = read_fen(rules, fen);
  if (position && !has_move(rules, *position)) {
    return failure(ErrorCode::invalid_argument, "There is no legal move in " + fen + ": the game is over.");
  }
  return position;
}

OpponentMove told(const Rules& rules, const Position& position, const Move& move, double score,
                  const std::vector<Move>& line) {
  OpponentMove answer;
  answer.move = path_text(rules, position, move);
  answer.score = score;
  Position at = position;
  for (const Move& step : line) {
    answer.line.push_back(pdn_text(rules, at, step));
    at = after(rules, at, step);
  }
  answer.acted_thinking_s = acted_thinking_s(rules, position);
  return answer;
}

class OwnMind final : public Mind {
 public:
  OwnMind(const Rules& rules, const OpponentOptions& options)
      : rules_(rules),
        plan_(plan_of_level(options.level)),
        seed_(options.seed),
        lockstep_(options.lockstep),
        searcher_(rules, plan_.evaluation, options.lockstep ? lockstep_table_bytes : own_mind_table_bytes) {}

  Result<OpponentMove> answer(const std::string& fen, const std::function<bool()>& give_up) override {
    const auto position = playable(rules_, fen);
    if (!position) return tl::make_unexpected(position.error());
    if (lockstep_) searcher_.clear();  // the answer depends on nothing but its arguments
    const Choice choice = choose(searcher_, rules_, *position, {}, plan_, seed_, give_up);
    return told(rules_, *position, choice.best.move, choice.best.value / static_cast<double>(man_value), choice.line);
  }

 private:
  const Rules& rules_;
  LevelPlan plan_;
  std::uint64_t seed_;
  bool lockstep_;
  Searcher searcher_;
};

// An engine that fails has lost; the game goes on to its end.
class HubMind final : public Mind {
 public:
  HubMind(const Rules& rules, HubClient client, double move_time_s)
      : rules_(rules), client_(std::move(client)), move_time_s_(move_time_s) {}

  Result<OpponentMove> answer(const std::string& fen, const std::function<bool()>& give_up) override {
    const auto position = playable(rules_, fen);
    if (!position) return tl::make_unexpected(position.error());
    const auto found = client_.ask(*position, move_time_s_, give_up);
    if (found) return told(rules_, *position, found->move, found->score, found->line);
    if (found.error().code == ErrorCode::refused) return tl::make_unexpected(found.error());
    OpponentMove resigns;
    resigns.move = opponent_resigns;
    resigns.note = found.error().message;
    return resigns;
  }

 private:
  const Rules& rules_;
  HubClient client_;
  double move_time_s_;
};

}  // namespace

Result<std::unique_ptr<Mind>> make_mind(const Rules& rules, const OpponentOptions& options) {
  if (options.mind.empty()) return std::make_unique<OwnMind>(rules, options);
  if (options.mind.rfind("hub:", 0) != 0) {
    return failure(ErrorCode::invalid_argument, "\"" + options.mind + "\" names no opponent; use hub:COMMAND.");
  }
  if (rules.id != RulesId::international) {
    return failure(ErrorCode::unsupported, "Hub engines play international rules only.");
  }
  auto client = HubClient::start(options.mind.substr(4));
  if (!client) return tl::make_unexpected(client.error());
  return std::make_unique<HubMind>(rules, std::move(*client), options.move_time_s);
}

}  // namespace counterpart
