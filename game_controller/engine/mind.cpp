#include "game_controller/engine/mind.hpp"

#include "game_controller/engine/endgame_cache.hpp"
#include "game_controller/engine/level.hpp"
#include "game_controller/links/dxp_partner.hpp"
#include "game_controller/links/hub_client.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

constexpr std::size_t own_mind_table_bytes = std::size_t{32} << 20;
constexpr std::size_t lockstep_table_bytes = std::size_t{4} << 20;  // cleared before each move, so small

constexpr std::uint64_t pondering_nodes = 5'000'000;  // some seconds: the machine has other things to do, too

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

OpponentMove resignation(const std::string& why) {
  OpponentMove resigns;
  resigns.move = opponent_resigns;
  resigns.note = why;
  return resigns;
}

class OwnMind final : public Mind {
 public:
  OwnMind(const Rules& rules, const OpponentOptions& options)
      : rules_(rules),
        plan_(plan_of_level(options.level)),
        seed_(options.seed),
        lockstep_(options.lockstep),
        searcher_(rules, plan_.evaluation, options.lockstep ? lockstep_table_bytes : own_mind_table_bytes) {
    if (lockstep_ || plan_.evaluation != Evaluation::trained) return;
    endgames_ = std::make_unique<EndgameCache>(rules);
    endgames_->make_in_background(EndgameTables::most_pieces);
    searcher_.use_endgames(&endgames_->tables());
  }

  Result<OpponentMove> answer(const std::string& fen, const std::function<bool()>& give_up) override {
    const auto position = playable(rules_, fen);
    if (!position) return tl::make_unexpected(position.error());
    if (lockstep_) searcher_.clear();  // the answer depends on nothing but its arguments
    const Choice choice = choose(searcher_, rules_, *position, {}, plan_, seed_, give_up);
    expected_.reset();
    if (choice.line.size() > 1) {
      expected_ = after(rules_, after(rules_, *position, choice.line[0]), choice.line[1]);
    }
    return told(rules_, *position, choice.best.move, choice.best.value / static_cast<double>(man_value), choice.line);
  }

  // Only the strongest level: what is thought here makes the next answer better than its level. The table remembers it.
  void ponder(const std::function<bool()>& give_up) override {
    if (!expected_ || plan_.nodes != plan_of_level(highest_level).nodes || !has_move(rules_, *expected_)) return;
    SearchLimits limits;
    limits.nodes = pondering_nodes;
    limits.give_up = give_up;
    static_cast<void>(searcher_.search(*expected_, {}, limits));
  }

 private:
  const Rules& rules_;
  std::optional<Position> expected_;  // when we shall be asked again
  LevelPlan plan_;
  std::uint64_t seed_;
  bool lockstep_;
  std::unique_ptr<EndgameCache> endgames_;  // none in lockstep: what is there depends on the clock
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
    return resignation(found.error().message);
  }

 private:
  const Rules& rules_;
  HubClient client_;
  double move_time_s_;
};

// One that is gone, silent or plays against the rules has lost, too.
class DxpMind final : public Mind {
 public:
  DxpMind(const Rules& rules, DxpPartner partner) : rules_(rules), partner_(std::move(partner)) {}

  Result<OpponentMove> answer(const std::string& fen, const std::function<bool()>& give_up) override {
    const auto position = playable(rules_, fen);
    if (!position) return tl::make_unexpected(position.error());
    const auto found = partner_.ask(*position, give_up);
    if (found) return told(rules_, *position, *found, 0, {*found});
    if (found.error().code == ErrorCode::refused) return tl::make_unexpected(found.error());
    return resignation(found.error().message);
  }

 private:
  const Rules& rules_;
  DxpPartner partner_;
};

bool begins_with(const std::string& text, const std::string& beginning) {
  return text.rfind(beginning, 0) == 0;
}

}  // namespace

Result<std::unique_ptr<Mind>> make_mind(const Rules& rules, const OpponentOptions& options) {
  if (options.mind.empty()) return std::make_unique<OwnMind>(rules, options);
  const bool by_hub = begins_with(options.mind, "hub:");
  const bool by_dxp = begins_with(options.mind, "dxp:");
  if (!by_hub && !by_dxp) {
    return failure(ErrorCode::invalid_argument,
                   "\"" + options.mind + "\" names no opponent; use hub:COMMAND or dxp:HOST:PORT.");
  }
  if (rules.id != RulesId::international) {
    return failure(ErrorCode::unsupported, "Hub engines and DXP players know international rules only.");
  }
  const std::string where = options.mind.substr(4);
  if (by_dxp) {
    auto partner = DxpPartner::connect(where);
    if (!partner) return tl::make_unexpected(partner.error());
    return std::make_unique<DxpMind>(rules, std::move(*partner));
  }
  auto client = HubClient::start(where);
  if (!client) return tl::make_unexpected(client.error());
  return std::make_unique<HubMind>(rules, std::move(*client), options.move_time_s);
}

}  // namespace counterpart
