#include "game_controller/engine/search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <optional>
#include <utility>

#include "game_controller/engine/endgame.hpp"
#include "game_controller/engine/transposition.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/record.hpp"

namespace counterpart {
namespace {

constexpr int max_ply = 120;
constexpr int infinite = win_value + 1;
constexpr int surely_won = win_value - 2 * max_ply;
// How far the resting search follows threats without captures. One ply beats two 59 to 41 and six 76 to 24 at equal
// nodes (4,000 a move): the nodes are better spent on depth.
constexpr int max_quiet_plies_in_threats = 1;

// A shallow search that beats beta by a margin foretells that the whole one beats beta (ProbCut, M. Buro 1995). 57 to
// 43 at equal nodes (30,000 a move), in 40 games only.
constexpr int least_depth_to_foretell = 5;
constexpr int foretelling_reduction = 3;
constexpr int foretelling_margin = 30;

struct GivenUp {};  // thrown through the recursion when a limit is reached

// Wins are stored as seen from the position itself, not from the root.
int to_table(int value, int ply) {
  return value > surely_won ? value + ply : value < -surely_won ? value - ply : value;
}

int from_table(int value, int ply) {
  return value > surely_won ? value - ply : value < -surely_won ? value + ply : value;
}

struct Killer {
  std::uint8_t from = 0;
  std::uint8_t to = 0;
};

bool same(const Killer& killer, const Move& move) {
  return killer.from == move.from && killer.to == move.to && killer.from != killer.to;
}

struct Line {
  std::array<Move, max_ply + 2> moves;
  int length = 0;

  void set(const Move& first, const Line& rest) {
    moves[0] = first;
    std::copy_n(rest.moves.begin(), rest.length, moves.begin() + 1);
    length = rest.length + 1;
  }
};

}  // namespace

struct Searcher::State {
  const Rules* rules;
  Evaluation evaluation;
  const PatternWeights* weights;
  const EndgameTables* endgames = nullptr;
  TranspositionTable table;
  std::array<std::array<int, 64>, 64> history{};
  std::array<std::array<Killer, 2>, max_ply + 2> killers{};
  std::vector<std::uint64_t> path;  // keys from the start of the game to here
  SearchLimits limits;
  Line found;  // the best line of the depth in work, as far as it has come
  std::uint64_t nodes = 0;
  std::uint64_t leaves = 0;
  std::uint64_t leaf_plies = 0;

  State(const Rules& r, Evaluation e, std::size_t bytes, const PatternWeights* w)
      : rules(&r), evaluation(e), weights(w), table(bytes) {}

  bool out_of_time() const {
    if (limits.nodes > 0 && nodes >= limits.nodes) return true;
    return nodes % 512 == 0 && limits.give_up && limits.give_up();
  }

  void count_node() {
    ++nodes;
    if (out_of_time()) throw GivenUp{};
  }

  // Only kings can come back to where they were, so a run of their moves is all that has to be looked at.
  bool is_repeated(std::uint64_t key, const Position& p) const {
    if (p.kings == 0) return false;
    for (std::size_t back = 4; back <= path.size() && back <= 60; back += 2) {
      if (path[path.size() - back] == key) return true;
    }
    return false;
  }

  std::optional<int> known_ending(const Position& p, int ply) const {
    if (endgames == nullptr || std::popcount(p.light | p.dark) > EndgameTables::most_pieces) return std::nullopt;
    const auto value = endgames->find(p);
    if (!value) return std::nullopt;
    const int chase_moves = lone_king_limit(*rules, p);
    if (chase_moves > 0 && value->plies > 2 * chase_moves) return 0;
    return value->outcome * (win_value - ply - value->plies);
  }

  int rest_value(const Position& p, int ply) {
    ++leaves;
    leaf_plies += static_cast<std::uint64_t>(ply);
    return evaluate(*rules, evaluation, weights, p);
  }

  // Captures are compulsory, so a position counts as quiet only when neither side could capture.
  int rest(const Position& p, int alpha, int beta, int ply, int quiet_plies) {
    count_node();
    if (const auto ending = known_ending(p, ply)) return *ending;
    MoveList moves;
    generate_captures(*rules, p, moves);
    if (moves.empty()) {
      Position threat = p;
      threat.turn = other(p.turn);
      const bool threatened = can_capture(*rules, threat);
      if (!threatened || quiet_plies >= max_quiet_plies_in_threats || ply >= max_ply) {
        if (!threatened && !has_quiet_move(*rules, p)) return -win_value + ply;
        return rest_value(p, ply);
      }
      generate_quiet(*rules, p, moves);
      if (moves.empty()) return -win_value + ply;
      order(moves, nullptr, ply);
      ++quiet_plies;
      // He who is threatened may also let it happen; his best move is searched, never less than that.
    }
    if (ply >= max_ply) return rest_value(p, ply);
    int best = -infinite;
    for (const Move& move : moves) {
      const int value = -rest(after(*rules, p, move), -beta, -std::max(alpha, best), ply + 1, quiet_plies);
      if (value > best) best = value;
      if (best >= beta) break;
    }
    return best;
  }

  void order(MoveList& moves, const Known* known, int ply) const {
    const auto& two = killers[static_cast<std::size_t>(ply)];
    int scores[MoveList::capacity];  // not initialised: this runs at every node
    Move* m = moves.begin();
    for (int i = 0; i < moves.size(); ++i) {
      const Move move = m[i];
      int score = history[move.from][move.to] + 64 * std::popcount(move.captured);
      if (known != nullptr && known->from == move.from && known->to == move.to) {
        score = 1 << 30;
      } else if (same(two[0], move)) {
        score = (1 << 29) + 1;
      } else if (same(two[1], move)) {
        score = 1 << 29;
      }
      int at = i;
      for (; at > 0 && scores[at - 1] < score; --at) {
        scores[at] = scores[at - 1];
        m[at] = m[at - 1];
      }
      scores[at] = score;
      m[at] = move;
    }
  }

  void reward(const Move& move, int depth, int ply) {
    if (move.captured != 0) return;
    auto& two = killers[static_cast<std::size_t>(ply)];
    if (!same(two[0], move)) {
      two[1] = two[0];
      two[0] = {move.from, move.to};
    }
    int& h = history[move.from][move.to];
    h += depth * depth;
    if (h > 1 << 24) {
      for (auto& row : history) {
        for (int& value : row) value /= 2;
      }
    }
  }

  int reduction(const Move& move, int depth, int index, bool in_line) const {
    if (depth < 2 || index < 1 || move.captured != 0) return 0;
    if (in_line) return depth >= 3 && index >= 3 ? 1 : 0;
    return index < 4 ? 1 : std::max(2, depth / 3);
  }

  bool is_foretold_above(const Position& p, int depth, int beta, int ply) {
    if (depth < least_depth_to_foretell || std::abs(beta) > surely_won) return false;
    const int bound = beta + foretelling_margin;
    Line unused;
    return search(p, depth - foretelling_reduction, bound - 1, bound, ply, unused) >= bound;
  }

  int search(const Position& p, int depth, int alpha, int beta, int ply, Line& line) {
    line.length = 0;
    if (depth <= 0) return rest(p, alpha, beta, ply, 0);
    count_node();
    const std::uint64_t key = key_of(p);
    if (ply > 0 && is_repeated(key, p)) return 0;
    if (ply >= max_ply) return rest_value(p, ply);
    if (ply > 0) {
      if (const auto ending = known_ending(p, ply)) return *ending;
    }

    const bool in_line = beta - alpha > 1;
    const Known* known = table.find(key);
    Known hint;
    if (known != nullptr) {
      hint = *known;
      known = &hint;
      const int value = from_table(hint.value, ply);
      if (ply > 0 && !in_line && hint.depth >= depth) {
        if (hint.bound == Bound::exact || (hint.bound == Bound::lower && value >= beta) ||
            (hint.bound == Bound::upper && value <= alpha)) {
          return value;
        }
      }
    }

    if (!in_line && is_foretold_above(p, depth, beta, ply)) return beta;

    MoveList moves;
    generate(*rules, p, moves);
    if (moves.empty()) return -win_value + ply;
    const int next_depth = moves.size() == 1 ? depth : depth - 1;  // a forced reply costs nothing
    order(moves, known, ply);

    path.push_back(key);
    struct PopPath {
      std::vector<std::uint64_t>& path;
      ~PopPath() { path.pop_back(); }
    } pop{path};

    int best = -infinite;
    Move best_move = moves[0];
    const int old_alpha = alpha;
    Line rest_line;
    for (int i = 0; i < moves.size(); ++i) {
      const Move& move = moves[i];
      const Position q = after(*rules, p, move);
      const int less = i == 0 ? 0 : reduction(move, depth, i, in_line);
      if (next_depth - less > 0) table.prefetch(key_of(q));
      int value = 0;
      if (i == 0) {
        value = -search(q, next_depth, -beta, -alpha, ply + 1, rest_line);
      } else {
        value = -search(q, next_depth - less, -alpha - 1, -alpha, ply + 1, rest_line);
        if (value > alpha && less > 0) value = -search(q, next_depth, -alpha - 1, -alpha, ply + 1, rest_line);
        if (value > alpha && value < beta) value = -search(q, next_depth, -beta, -alpha, ply + 1, rest_line);
      }
      if (value > best) {
        best = value;
        best_move = move;
        if (value > alpha) {
          alpha = value;
          line.set(move, rest_line);
          if (ply == 0) found = line;
        }
      }
      if (alpha >= beta) {
        reward(move, depth, ply);
        break;
      }
    }
    const Bound bound = best >= beta ? Bound::lower : best > old_alpha ? Bound::exact : Bound::upper;
    table.keep(key, {0, static_cast<std::int16_t>(to_table(best, ply)), static_cast<std::int8_t>(depth), bound,
                     best_move.from, best_move.to, 0});
    return best;
  }

  // A narrow window round the last value first.
  int search_root(const Position& root, int depth, int guess, Line& line) {
    int width = depth < 4 ? 2 * infinite : 25;
    int low = std::max(-infinite, guess - width);
    int high = std::min(infinite, guess + width);
    while (true) {
      const int value = search(root, depth, low, high, 0, line);
      if (value > low && value < high) return value;
      if (value <= low && low == -infinite) return value;
      if (value >= high && high == infinite) return value;
      width *= 4;
      if (value <= low) low = width > 400 ? -infinite : std::max(-infinite, value - width);
      if (value >= high) high = width > 400 ? infinite : std::min(infinite, value + width);
    }
  }

  void begin(const std::vector<std::uint64_t>& earlier, const SearchLimits& new_limits) {
    limits = new_limits;
    path = earlier;
    nodes = leaves = leaf_plies = 0;
    killers = {};
    table.new_search();
    for (auto& row : history) {
      for (int& value : row) value /= 8;
    }
  }

  SearchReport report(int depth, int value, const Line& line) const {
    SearchReport r;
    r.depth = depth;
    r.value = value;
    r.nodes = nodes;
    r.mean_depth = leaves == 0 ? depth : static_cast<double>(leaf_plies) / static_cast<double>(leaves);
    r.line.assign(line.moves.begin(), line.moves.begin() + line.length);
    return r;
  }
};

Searcher::Searcher(const Rules& rules, Evaluation evaluation, std::size_t table_bytes, const PatternWeights* weights)
    : state_(std::make_unique<State>(rules, evaluation, table_bytes, weights)) {}
Searcher::~Searcher() = default;
Searcher::Searcher(Searcher&&) noexcept = default;

void Searcher::use_endgames(const EndgameTables* tables) {
  state_->endgames = tables != nullptr && tables->rules().id == state_->rules->id ? tables : nullptr;
}

void Searcher::clear() {
  state_->table.clear();
  state_->history = {};
}

SearchReport Searcher::search(const Position& root, const std::vector<std::uint64_t>& earlier,
                              const SearchLimits& limits, const std::function<void(const SearchReport&)>& on_depth) {
  State& s = *state_;
  s.begin(earlier, limits);
  SearchReport best;
  MoveList moves;
  generate(*s.rules, root, moves);
  if (moves.empty()) {
    best.value = -win_value;
    return best;
  }
  best.line = {moves[0]};
  for (int depth = 1; depth <= std::min(limits.depth, max_ply - 1); ++depth) {
    auto line = std::make_unique<Line>();
    s.found.length = 0;
    try {
      const int value = s.search_root(root, depth, best.value, *line);
      if (line->length > 0) best = s.report(depth, value, *line);
    } catch (const GivenUp&) {
      s.path.clear();
      // The move of the last depth is tried first, so what has been found since is better.
      if (s.found.length > 0) best.line.assign(s.found.moves.begin(), s.found.moves.begin() + s.found.length);
      best.nodes = s.nodes;
      break;
    }
    if (on_depth) on_depth(best);
    if (std::abs(best.value) > surely_won && depth > win_value - std::abs(best.value)) break;
    if (limits.deep_enough && limits.deep_enough()) break;
  }
  return best;
}

std::vector<ScoredMove> Searcher::rank(const Position& root, const std::vector<std::uint64_t>& earlier, int depth) {
  State& s = *state_;
  s.begin(earlier, {});
  MoveList moves;
  generate(*s.rules, root, moves);
  std::vector<ScoredMove> ranked;
  s.path.push_back(key_of(root));
  for (const Move& move : moves) {
    auto line = std::make_unique<Line>();
    const int value = -s.search(after(*s.rules, root, move), depth - 1, -infinite, infinite, 1, *line);
    ranked.push_back({move, value});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& a, const auto& b) { return a.value > b.value; });
  return ranked;
}

}  // namespace counterpart
