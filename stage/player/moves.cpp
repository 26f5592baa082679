#include "stage/player/moves.hpp"

#include "game_controller/notation/fen.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/routes.hpp"

namespace counterpart::stage {

std::vector<PlayerMove> legal_moves(const std::string& rules_name, const std::string& squares, Side turn) {
  const Rules* rules = find_rules(rules_name);
  if (rules == nullptr) return {};
  const Result<Position> position = read_squares(*rules, squares, turn);
  if (!position) return {};
  MoveList moves;
  generate(*rules, *position, moves);
  std::vector<PlayerMove> result;
  for (const Move& move : moves) {
    const Route route = routes(*rules, *position, move).front();
    result.push_back({route.squares, route.captured});
  }
  return result;
}

}  // namespace counterpart::stage
