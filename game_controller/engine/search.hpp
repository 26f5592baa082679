// Iterative alpha-beta: the best move of a position within limits.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "game_controller/engine/evaluate.hpp"
#include "game_controller/rules/move.hpp"
#include "game_controller/rules/position.hpp"
#include "game_controller/rules/rules.hpp"

namespace counterpart {

class EndgameTables;

struct SearchLimits {
  int depth = 60;
  std::uint64_t nodes = 0;            // 0: no limit
  std::function<bool()> give_up;      // asked every 512 nodes: stop at once? Empty: never
  std::function<bool()> deep_enough;  // asked after each depth: begin no deeper one? Empty: never
};

struct ScoredMove {
  Move move{};
  int value = 0;  // hundredths of a man, for the side to move
};

struct SearchReport {
  int depth = 0;
  double mean_depth = 0;  // plies from the root at which positions were evaluated
  int value = 0;
  std::uint64_t nodes = 0;
  std::vector<Move> line;  // expected continuation, the best move first; empty if there is no legal move
};

class Searcher {
 public:
  // weights: see `evaluate`; they must outlive this.
  Searcher(const Rules& rules, Evaluation evaluation, std::size_t table_bytes, const PatternWeights* weights = nullptr);
  ~Searcher();
  Searcher(Searcher&&) noexcept;

  // Of the same rules. The tables must outlive this and may grow meanwhile; nullptr: none.
  void use_endgames(const EndgameTables* tables);

  // Forgets everything learnt: a new game.
  void clear();

  // earlier: keys of the positions of the game before this one, for repetitions. on_depth is called after each depth
  // (and must be quick). With the same arguments after `clear`, and without give_up and deep_enough, always the same.
  SearchReport search(const Position& root, const std::vector<std::uint64_t>& earlier, const SearchLimits& limits,
                      const std::function<void(const SearchReport&)>& on_depth = {});

  // Exact values of all legal moves, best first, at a fixed depth.
  std::vector<ScoredMove> rank(const Position& root, const std::vector<std::uint64_t>& earlier, int depth);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace counterpart
