#include "game_controller/rules/record.hpp"

#include <algorithm>
#include <bit>

#include "game_controller/rules/generate.hpp"

namespace counterpart {

int lone_king_limit(const Rules& rules, const Position& position) {
  for (const Side side : {Side::light, Side::dark}) {
    const Bits weak = pieces_of(position, side);
    const Bits strong = pieces_of(position, other(side));
    if (std::popcount(weak) != 1 || (weak & position.kings) == 0 || (strong & position.kings) == 0) continue;
    const int n = std::popcount(strong);
    for (const LoneKingLimit& limit : rules.lone_king) {
      if (limit.moves_each > 0 && n >= limit.strong_pieces_min && n <= limit.strong_pieces_max) return limit.moves_each;
    }
  }
  return 0;
}

Record::Record(const Rules& rules, const Position& start) : rules_(&rules) {
  steps_.push_back({start, key_of(start), 0, lone_king_limit(rules, start), 0});
}

void Record::play(const Move& move) {
  const Step& last = steps_.back();
  Step next;
  next.position = after(*rules_, last.position, move);
  next.key = key_of(next.position);
  const bool by_king = (last.position.kings & one(move.from)) != 0;
  next.kings_only_plies = by_king && move.captured == 0 ? last.kings_only_plies + 1 : 0;
  next.lone_king_limit = lone_king_limit(*rules_, next.position);
  next.lone_king_plies = next.lone_king_limit == last.lone_king_limit ? last.lone_king_plies + 1 : 0;
  steps_.push_back(next);
  moves_.push_back(move);
}

void Record::undo() {
  if (moves_.empty()) return;
  moves_.pop_back();
  steps_.pop_back();
}

std::vector<std::uint64_t> Record::keys() const {
  std::vector<std::uint64_t> keys;
  for (const Step& step : steps_) keys.push_back(step.key);
  return keys;
}

std::optional<Ending> Record::ending() const {
  const Step& now = steps_.back();
  if (!has_move(*rules_, now.position)) {
    return Ending{now.position.turn == Side::light ? GameResult::dark_wins : GameResult::light_wins, "no_moves"};
  }
  const auto same = std::count_if(steps_.begin(), steps_.end(), [&](const Step& s) { return s.key == now.key; });
  if (same >= rules_->repetitions) return Ending{GameResult::draw, "repetition"};
  if (now.kings_only_plies >= 2 * rules_->kings_only_moves_each) return Ending{GameResult::draw, "kings_only"};
  if (now.lone_king_limit > 0 && now.lone_king_plies >= 2 * now.lone_king_limit) {
    return Ending{GameResult::draw, "lone_king"};
  }
  return std::nullopt;
}

}  // namespace counterpart
