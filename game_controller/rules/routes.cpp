#include "game_controller/rules/routes.hpp"

#include <algorithm>

#include "protocol/vocabulary/board_geometry.hpp"

namespace counterpart {
namespace {

constexpr std::size_t most_routes = 20'000;

constexpr Cell directions[] = {{-1, -1}, {-1, 1}, {1, -1}, {1, 1}};

struct Walk {
  const Rules& rules;
  Bits foes;
  Bits open;  // squares without a piece, the piece's own square included
  bool is_king;
  Side side;
  JumpedPieces jumped;
  std::vector<Route>& found;
};

Bits mask_at(Cell cell, int n) {
  const auto square = square_of_cell(cell, n);
  return square ? square_mask(*square, n) : 0;
}

Cell next(Cell cell, Cell direction) {
  return {cell.row + direction.row, cell.col + direction.col};
}

bool may_capture_towards(const Walk& walk, Cell direction) {
  if (walk.is_king || walk.rules.men_capture_backwards) return true;
  return (walk.side == Side::light) == (direction.row < 0);
}

void follow(const Walk& walk, const Route& so_far, Bits captured);

// Captures one piece in this direction and goes on from every landing square. Says whether there was one.
bool jump(const Walk& walk, const Route& so_far, Bits captured, Cell direction) {
  const int n = walk.rules.squares;
  const bool flies = walk.is_king && walk.rules.flying_kings;
  const Bits open = walk.jumped == JumpedPieces::leave_at_once ? walk.open | captured : walk.open;
  Cell cell = next(cell_of_square(so_far.squares.back(), n), direction);
  while (flies && (mask_at(cell, n) & open) != 0) cell = next(cell, direction);
  const Bits foe = mask_at(cell, n) & walk.foes & ~captured;
  if (foe == 0) return false;
  bool any = false;
  for (Cell landing = next(cell, direction); (mask_at(landing, n) & open) != 0; landing = next(landing, direction)) {
    any = true;
    Route longer = so_far;
    longer.squares.push_back(*square_of_cell(landing, n));
    longer.captured.push_back(*square_of_cell(cell, n));
    follow(walk, longer, captured | foe);
    if (!flies) break;
  }
  return any;
}

void follow(const Walk& walk, const Route& so_far, Bits captured) {
  if (walk.found.size() >= most_routes) return;
  const std::size_t mine = walk.found.size();
  if (!so_far.captured.empty()) walk.found.push_back(so_far);
  bool more = false;
  for (const Cell direction : directions) {
    if (may_capture_towards(walk, direction)) more |= jump(walk, so_far, captured, direction);
  }
  if (!so_far.captured.empty()) walk.found[mine].complete = !more;
}

}  // namespace

std::vector<Route> capture_routes(const Rules& rules, const Position& position, int from, JumpedPieces jumped) {
  std::vector<Route> found;
  const Bits piece = one(from);
  const Bits all = position.light | position.dark;
  const Side side = (position.light & piece) != 0 ? Side::light : Side::dark;
  const Walk walk{rules,
                  pieces_of(position, other(side)),
                  all_squares(rules.squares) & ~(all & ~piece),
                  (position.kings & piece) != 0,
                  side,
                  jumped,
                  found};
  follow(walk, Route{{square_of_bit(from, rules.squares)}, {}, true}, 0);
  return found;
}

std::vector<Route> routes(const Rules& rules, const Position& position, const Move& move) {
  const int n = rules.squares;
  const int to = square_of_bit(move.to, n);
  if (move.captured == 0) return {Route{{square_of_bit(move.from, n), to}, {}, true}};
  std::vector<Route> ways;
  for (Route& route : capture_routes(rules, position, move.from)) {
    if (route.squares.back() == to && bits_of_squares(route.captured, n) == move.captured) {
      ways.push_back(std::move(route));
    }
  }
  return ways;
}

Bits bits_of_squares(const std::vector<int>& squares, int squares_a_side) {
  Bits bits = 0;
  for (const int square : squares) bits |= square_mask(square, squares_a_side);
  return bits;
}

std::vector<int> squares_of_bits(Bits bits, int squares_a_side) {
  std::vector<int> squares;
  for (; bits != 0; bits &= bits - 1) squares.push_back(square_of_bit(lowest(bits), squares_a_side));
  return squares;
}

}  // namespace counterpart
