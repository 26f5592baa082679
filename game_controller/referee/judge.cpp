#include "game_controller/referee/judge.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/routes.hpp"

namespace counterpart {
namespace {

Bits pieces(const Position& p) {
  return p.light | p.dark;
}

// What is different, by side: squares left and squares newly taken.
struct Changes {
  Bits own_gone, own_new, foe_gone, foe_new;
};

Changes changes_between(const Position& before, const Position& after) {
  const Bits own_before = own(before);
  const Bits own_after = pieces_of(after, before.turn);
  const Bits foe_before = foe(before);
  const Bits foe_after = pieces_of(after, other(before.turn));
  return {own_before & ~own_after, own_after & ~own_before, foe_before & ~foe_after, foe_after & ~foe_before};
}

class Judge {
 public:
  Judge(const Rules& rules, const Position& before) : rules_(rules), n_(rules.squares), before_(before) {
    generate(rules, before, legal_);
  }

  Verdict whole_board(const Position& after, const std::vector<Cell>& strays) const;
  Verdict own_pieces(Bits own_after, const std::vector<Cell>& strays) const;

 private:
  Verdict because(const char* reason, Bits squares) const {
    return {std::nullopt, reason, squares_of_bits(squares, n_)};
  }

  Verdict foe_moved(const Changes& c) const;
  Verdict own_missing_as_well(const Changes& c) const;
  Verdict one_moved(Bits from, Bits to, std::optional<Bits> removed) const;
  std::optional<Verdict> capture_attempt(Bits from, Bits to, Bits removed) const;
  std::optional<Verdict> short_capture(Bits from, Bits to, std::optional<Bits> removed) const;
  std::optional<Verdict> wrong_removal(const std::vector<Route>& ways, Bits to, Bits removed) const;
  Verdict how_it_went(Bits from, Bits to) const;
  std::optional<Verdict> crowns(const Position& after) const;

  bool is_legal(Bits from, Bits to, Bits removed) const {
    return std::any_of(legal_.begin(), legal_.end(),
                       [&](const Move& m) { return one(m.from) == from && one(m.to) == to && m.captured == removed; });
  }
  bool is_step(Bits from, Bits to) const {
    MoveList quiet;
    generate_quiet(rules_, before_, quiet);
    return std::any_of(quiet.begin(), quiet.end(),
                       [&](const Move& m) { return one(m.from) == from && one(m.to) == to; });
  }
  Bits must_move() const {
    Bits squares = 0;
    for (const Move& move : legal_) squares |= one(move.from);
    return squares;
  }
  Cell cell(Bits square) const { return cell_of_square(square_of_bit(lowest(square), n_), n_); }
  Bits at(Cell c) const {
    const auto square = square_of_cell(c, n_);
    return square ? square_mask(*square, n_) : 0;
  }
  Bits between(Bits from, Bits to) const;

  const Rules& rules_;
  int n_;
  Position before_;
  MoveList legal_;
};

int count(Bits bits) {
  return std::popcount(bits);
}

int sign(int x) {
  return (x > 0) - (x < 0);
}

// Squares strictly between two on one diagonal.
Bits Judge::between(Bits from, Bits to) const {
  const Cell a = cell(from);
  const Cell b = cell(to);
  const Cell step{sign(b.row - a.row), sign(b.col - a.col)};
  Bits squares = 0;
  for (Cell c{a.row + step.row, a.col + step.col}; !(c == b); c = {c.row + step.row, c.col + step.col})
    squares |= at(c);
  return squares;
}

Verdict Judge::whole_board(const Position& seen, const std::vector<Cell>& strays) const {
  const Changes c = changes_between(before_, seen);
  if (!strays.empty()) return because("light_square", c.own_gone | c.foe_gone);
  for (const Move& move : legal_) {
    Position next = after(rules_, before_, move);
    next.turn = seen.turn;
    if (next == seen) return {move, "", {}};
  }
  if ((c.own_gone | c.own_new | c.foe_gone | c.foe_new) == 0) {
    return crowns(seen).value_or(because("no_change", 0));
  }
  if (count(c.own_new) > count(c.own_gone)) return because("piece_appeared", c.own_new);
  if (count(c.foe_new) > count(c.foe_gone)) return because("piece_appeared", c.foe_new);
  if (c.foe_new != 0) return foe_moved(c);
  if (c.own_new == 0) return because("piece_vanished", c.own_gone | c.foe_gone);
  if (count(c.own_new) > 1) return because("two_pieces_moved", c.own_gone | c.own_new);
  if (count(c.own_gone) > 1) return own_missing_as_well(c);
  if (is_legal(c.own_gone, c.own_new, c.foe_gone)) {
    if (const auto wrong = crowns(seen)) return *wrong;
  }
  return one_moved(c.own_gone, c.own_new, c.foe_gone);
}

Verdict Judge::own_pieces(Bits own_after, const std::vector<Cell>& strays) const {
  const Bits gone = own(before_) & ~own_after;
  const Bits fresh = own_after & ~own(before_);
  if (!strays.empty()) return because("light_square", gone);
  const auto matching = matching_moves(rules_, before_, own_after);
  if (!matching.empty() && (gone | fresh) != 0) return {matching.front(), "", {}};
  if ((gone | fresh) == 0) return because("no_change", 0);
  if (count(fresh) > count(gone)) return because("piece_appeared", fresh);
  if (fresh == 0) return because("piece_vanished", gone);
  if (count(fresh) > 1) return because("two_pieces_moved", gone | fresh);
  if (count(gone) > 1) return own_missing_as_well({gone, fresh, 0, 0});
  return one_moved(gone, fresh, std::nullopt);
}

Verdict Judge::foe_moved(const Changes& c) const {
  if (c.own_new == 0 && count(c.foe_new) == 1 && count(c.foe_gone) == 1) {
    if (c.own_gone == 0) return because("not_your_turn", c.foe_gone | c.foe_new);
    Position theirs = before_;
    theirs.turn = other(before_.turn);
    if (Judge(rules_, theirs).is_legal(c.foe_gone, c.foe_new, c.own_gone)) {
      return because("not_your_turn", c.foe_gone | c.foe_new);
    }
  }
  return because("opponent_piece_moved", c.foe_gone | c.foe_new);
}

Verdict Judge::own_missing_as_well(const Changes& c) const {
  if (count(c.own_gone) == 2) {
    for (Bits rest = c.own_gone; rest != 0; rest &= rest - 1) {
      const Bits from = rest & (~rest + 1);
      const Bits missing = c.own_gone & ~from;
      if (c.foe_gone != 0 && is_legal(from, c.own_new, c.foe_gone)) return because("extra_piece_removed", missing);
      const Cell a = cell(from);
      const Cell b = cell(c.own_new);
      if (std::abs(a.row - b.row) == std::abs(a.col - b.col) && between(from, c.own_new) == missing) {
        return because("jumped_own_piece", missing);
      }
    }
  }
  return because("piece_vanished", c.own_gone);
}

// removed: the other side's pieces that are gone; empty if that could not be seen.
Verdict Judge::one_moved(Bits from, Bits to, std::optional<Bits> removed) const {
  if (const auto verdict = short_capture(from, to, removed)) return *verdict;
  if (removed) {
    if (const auto verdict = capture_attempt(from, to, *removed)) return *verdict;
  }
  if (is_step(from, to)) {
    if (removed && *removed != 0) return because("piece_vanished", *removed);
    return because("must_capture", must_move());
  }
  return how_it_went(from, to);
}

// A capture that may be begun so, but is not the whole or the largest.
std::optional<Verdict> Judge::short_capture(Bits from, Bits to, std::optional<Bits> removed) const {
  const auto ways = capture_routes(rules_, before_, lowest(from));
  for (const bool complete : {true, false}) {
    for (const Route& way : ways) {
      if (way.complete != complete || square_mask(way.squares.back(), n_) != to) continue;
      if (removed && bits_of_squares(way.captured, n_) != *removed) continue;
      return because(complete ? "not_maximum" : "capture_not_finished", must_move());
    }
  }
  return std::nullopt;
}

std::optional<Verdict> Judge::capture_attempt(Bits from, Bits to, Bits removed) const {
  if (removed != 0) {
    for (const Route& way : capture_routes(rules_, before_, lowest(from), JumpedPieces::leave_at_once)) {
      if (square_mask(way.squares.back(), n_) == to && bits_of_squares(way.captured, n_) == removed) {
        return because("piece_jumped_twice", removed);
      }
    }
  }
  const auto ways = capture_routes(rules_, before_, lowest(from));
  if (const auto verdict = wrong_removal(ways, to, removed)) return verdict;
  if (removed == 0) return std::nullopt;
  const bool took_these = std::any_of(ways.begin(), ways.end(),
                                      [&](const Route& way) { return bits_of_squares(way.captured, n_) == removed; });
  if (took_these || (to & removed) != 0) return because("wrong_landing", to);
  return std::nullopt;
}

// The landing of a possible capture, legal ones first, with other pieces taken off than those jumped.
std::optional<Verdict> Judge::wrong_removal(const std::vector<Route>& ways, Bits to, Bits removed) const {
  std::vector<Bits> jumped;
  for (const Move& move : legal_) {
    if (move.captured != 0 && square_of_bit(move.from, n_) == (ways.empty() ? 0 : ways.front().squares.front()) &&
        one(move.to) == to) {
      jumped.push_back(move.captured);
    }
  }
  for (const Route& way : ways) {
    if (square_mask(way.squares.back(), n_) == to) jumped.push_back(bits_of_squares(way.captured, n_));
  }
  for (const Bits set : jumped) {
    if ((removed & ~set) == 0) return because("captured_left_on_board", set & ~removed);
  }
  for (const Bits set : jumped) {
    if ((set & ~removed) == 0) return because("extra_piece_removed", removed & ~set);
  }
  if (!jumped.empty()) return because("wrong_piece_removed", removed & ~jumped.front());
  return std::nullopt;
}

Verdict Judge::how_it_went(Bits from, Bits to) const {
  const Cell a = cell(from);
  const Cell b = cell(to);
  const int rows = b.row - a.row;
  const bool is_king = (before_.kings & from) != 0;
  if (std::abs(rows) != std::abs(b.col - a.col)) return because("not_diagonal", from | to);
  if ((foe(before_) & to) != 0) return because("wrong_landing", to);
  const Bits over = between(from, to);
  const Bits own_over = over & own(before_);
  if (is_king && rules_.flying_kings) return because("path_blocked", over & pieces(before_));
  const bool forwards = (before_.turn == Side::light) == (rows < 0);
  if (std::abs(rows) == 2 && own_over != 0) return because("jumped_own_piece", own_over);
  const bool jumped_backwards = std::abs(rows) == 2 && (over & foe(before_)) != 0;
  if (!is_king && !forwards && (std::abs(rows) == 1 || (jumped_backwards && !rules_.men_capture_backwards))) {
    return because("moved_backwards", from | to);
  }
  return because("moved_too_far", from | to);
}

// Kings and men other than they should be, on a board that is otherwise as a legal move leaves it or unchanged.
std::optional<Verdict> Judge::crowns(const Position& seen) const {
  const Changes c = changes_between(before_, seen);
  Bits kings = before_.kings;
  if (c.own_new != 0) {
    for (const Move& move : legal_) {
      if (one(move.from) == c.own_gone && one(move.to) == c.own_new && move.captured == c.foe_gone) {
        kings = after(rules_, before_, move).kings;
      }
    }
  }
  const Bits missing = kings & ~seen.kings & pieces(seen);
  const Bits false_kings = seen.kings & ~kings;
  if (missing != 0) return because("not_crowned", missing);
  if (false_kings != 0) return because("crowned_wrongly", false_kings);
  return std::nullopt;
}

}  // namespace

Verdict judge(const Rules& rules, const Position& before, const Position& after_seen, const std::vector<Cell>& strays) {
  return Judge(rules, before).whole_board(after_seen, strays);
}

Verdict judge_own(const Rules& rules, const Position& before, Bits own_after, const std::vector<Cell>& strays) {
  return Judge(rules, before).own_pieces(own_after, strays);
}

std::vector<Move> matching_moves(const Rules& rules, const Position& before, Bits own_after) {
  MoveList legal;
  generate(rules, before, legal);
  std::vector<Move> matching;
  for (const Move& move : legal) {
    if (((own(before) & ~one(move.from)) | one(move.to)) == own_after) matching.push_back(move);
  }
  return matching;
}

std::vector<std::string> legal_moves_text(const Rules& rules, const Position& position, std::size_t most) {
  MoveList legal;
  generate(rules, position, legal);
  std::vector<std::string> texts;
  for (const Move& move : legal) texts.push_back(hub_text(rules, move));
  std::sort(texts.begin(), texts.end());
  if (texts.size() > most) texts.resize(most);
  return texts;
}

}  // namespace counterpart
