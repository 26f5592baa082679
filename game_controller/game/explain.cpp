// What the virtual player explains: a hint, what was wrong with the last move, and rules that surprise people.
#include <algorithm>

#include "game_controller/engine/search.hpp"
#include "game_controller/game/state.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/referee/sentences.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

constexpr std::size_t explaining_table_bytes = std::size_t{1} << 20;
constexpr std::uint64_t hint_nodes = 20'000;  // a hundredth of a second: it is done within a frame
constexpr std::size_t longest_told_line = 5;
constexpr int as_good = man_value / 4;  // a move that is worse by no more is not found fault with

SearchReport look_ahead(const Record& record) {
  Searcher searcher(record.rules(), Evaluation::trained, explaining_table_bytes);
  std::vector<std::uint64_t> earlier = record.keys();
  earlier.pop_back();
  SearchLimits limits;
  limits.nodes = hint_nodes;
  return searcher.search(record.position(), earlier, limits);
}

// "32-28, then 19-23 and 28x19"
std::string spoken(const Rules& rules, Position at, const std::vector<Move>& line) {
  std::string text;
  const std::size_t n = std::min(line.size(), longest_told_line);
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) text += i == 1 ? ", then " : i + 1 == n ? " and " : ", ";
    text += pdn_text(rules, at, line[i]);
    at = after(rules, at, line[i]);
  }
  return text;
}

bool goes_back(const Route& route, Side mover, int squares_a_side) {
  const int per_row = squares_a_side / 2;
  for (std::size_t i = 1; i < route.squares.size(); ++i) {
    const int down = (route.squares[i] - 1) / per_row - (route.squares[i - 1] - 1) / per_row;
    if (mover == Side::light ? down > 0 : down < 0) return true;
  }
  return false;
}

// Would a smaller capture have been possible if the rules did not ask for the largest?
bool smaller_was_there(const Rules& rules, const Position& position, int captured) {
  for (Bits rest = own(position); rest != 0; rest &= rest - 1) {
    for (const Route& way : capture_routes(rules, position, lowest(rest))) {
      if (way.complete && static_cast<int>(way.captured.size()) < captured) return true;
    }
  }
  return false;
}

}  // namespace

void Game::State::hint(const std::string& about) {
  if (about == "last") return explain_last();
  if (!real_to_move() || (phase != GamePhase::real_to_move && phase != GamePhase::illegal)) {
    out.rejected.push_back("There is no hint now; ask when it is your turn.");
    return;
  }
  const SearchReport report = look_ahead(record);
  if (report.line.empty()) return;
  const int from = square_of_bit(report.line.front().from, rules->squares);
  human.point_at(from, "hint", "You could play " + spoken(*rules, record.position(), report.line) + ".");
}

// Of the real player: what followed from his last move and what would have been better.
void Game::State::explain_last() {
  std::size_t ply = record.moves().size();
  while (ply > 0 && record.position_before(ply - 1).turn != real_side()) --ply;
  if (ply == 0) {
    out.rejected.push_back("There is no move of yours to explain yet.");
    return;
  }
  Record before(*rules, record.start());
  for (std::size_t i = 0; i + 1 < ply; ++i) before.play(record.moves()[i]);
  const Move& made = record.moves()[ply - 1];
  const std::string name = pdn_text(*rules, before.position(), made);
  const SearchReport best = look_ahead(before);
  Record then = before;
  then.play(made);
  const SearchReport answer = look_ahead(then);
  if (best.line.empty() || best.line.front() == made || best.value + answer.value <= as_good) {
    return human.say("last_move_good", "Your move " + name + " was good.");
  }
  human.say("last_move_weak", "After your move " + name + " I can play " +
                                  spoken(*rules, then.position(), answer.line) + ". Better was " +
                                  spoken(*rules, before.position(), best.line) + ".");
}

// Players take some legal captures for errors; each such rule is told the first time it shows.
void Game::State::explain_surprise(const Position& before, const Move& move, const Route& route) {
  if (move.captured == 0) return;
  const bool man = (before.kings & one(move.from)) == 0;
  const auto once = [&](const char* code, const std::vector<int>& about) {
    if (std::find(explained.begin(), explained.end(), code) != explained.end()) return;
    explained.emplace_back(code);
    human.say(code, sentence(code, about));
  };
  if (man && goes_back(route, before.turn, rules->squares)) once("backward_capture", {});
  if (rules->majority && smaller_was_there(*rules, before, static_cast<int>(route.captured.size()))) {
    once("majority", {route.squares.front()});
  }
}

}  // namespace counterpart
