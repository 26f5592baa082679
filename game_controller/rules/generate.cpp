#include "game_controller/rules/generate.hpp"

#include <algorithm>
#include <bit>

namespace counterpart {
namespace {

// The four directions, so that d ^ 3 is the opposite one and d ^ 1, d ^ 2 are those at right angles.
enum Direction { up_left = 0, up_right = 1, down_left = 2, down_right = 3 };

template <const Rules& R>
struct Board {
  using L = Layout<R.squares>;
  static constexpr int steps[4] = {L::up_left, L::up_right, L::down_left, L::down_right};

  template <int D>
  static constexpr Bits step(Bits bits) {
    return shifted<steps[D]>(bits);
  }
};

// What one side sees; `open` is where nothing stands.
struct View {
  Bits men;
  Bits kings;
  Bits foes;
  Bits open;
};

template <const Rules& R, Side S>
View view_of(const Position& p) {
  const Bits mine = S == Side::light ? p.light : p.dark;
  const Bits theirs = S == Side::light ? p.dark : p.light;
  return {mine & ~p.kings, mine & p.kings, theirs, Board<R>::L::all & ~(mine | theirs)};
}

template <const Rules& R, int D>
Bits jumpers_towards(Bits pieces, const View& v) {
  using B = Board<R>;
  return pieces & B::template step<D ^ 3>(v.foes & B::template step<D ^ 3>(v.open));
}

// Men (or short kings) that have a capture.
template <const Rules& R, Side S>
Bits jumping_men(const View& v) {
  Bits jumpers = 0;
  if constexpr (R.men_capture_backwards || S == Side::light) {
    jumpers |= jumpers_towards<R, up_left>(v.men, v) | jumpers_towards<R, up_right>(v.men, v);
  }
  if constexpr (R.men_capture_backwards || S == Side::dark) {
    jumpers |= jumpers_towards<R, down_left>(v.men, v) | jumpers_towards<R, down_right>(v.men, v);
  }
  return jumpers;
}

template <const Rules& R>
Bits jumping_short_kings(const View& v) {
  return jumpers_towards<R, up_left>(v.kings, v) | jumpers_towards<R, up_right>(v.kings, v) |
         jumpers_towards<R, down_left>(v.kings, v) | jumpers_towards<R, down_right>(v.kings, v);
}

template <const Rules& R, int D>
bool flying_king_jumps(Bits king, const View& v) {
  using B = Board<R>;
  Bits at = B::template step<D>(king);
  while ((at & v.open) != 0) at = B::template step<D>(at);
  return (at & v.foes) != 0 && (B::template step<D>(at) & v.open) != 0;
}

template <const Rules& R>
Bits jumping_kings(const View& v) {
  if constexpr (!R.flying_kings) {
    return jumping_short_kings<R>(v);
  } else {
    Bits jumpers = 0;
    for (Bits rest = v.kings; rest != 0; rest &= rest - 1) {
      const Bits king = rest & (~rest + 1);
      if (flying_king_jumps<R, up_left>(king, v) || flying_king_jumps<R, up_right>(king, v) ||
          flying_king_jumps<R, down_left>(king, v) || flying_king_jumps<R, down_right>(king, v)) {
        jumpers |= king;
      }
    }
    return jumpers;
  }
}

// Follows captures of one piece to their ends. Captured pieces stay on the board until the move is complete and may not
// be jumped again (FMJD Annex 1 art. 4.8); the square the piece came from is free for it.
template <const Rules& R, Side S>
class CaptureSearch {
 public:
  CaptureSearch(const View& v, MoveList& moves) : foes_(v.foes), open_(v.open), moves_(moves) {}

  void man(Bits at) {
    begin(at);
    step_man(at, 0, 0);
    open_ &= ~at;
  }

  void king(Bits at) {
    begin(at);
    if constexpr (R.flying_kings) {
      fly<up_left>(at, 0, 0);
      fly<up_right>(at, 0, 0);
      fly<down_left>(at, 0, 0);
      fly<down_right>(at, 0, 0);
    } else {
      step_king(at, 0, 0);
    }
    open_ &= ~at;
  }

 private:
  using B = Board<R>;

  void begin(Bits at) {
    from_ = static_cast<std::uint8_t>(lowest(at));
    open_ |= at;
  }

  void add(Bits at, Bits captured, int n) {
    if constexpr (R.majority) {
      if (n < most_) return;
      if (n > most_) {
        most_ = n;
        moves_.clear();
      }
    }
    const Move move{captured, from_, static_cast<std::uint8_t>(lowest(at))};
    // Fewer than three captures cannot be made in two orders with the same ends.
    if (n >= 3 && std::find(moves_.begin(), moves_.end(), move) != moves_.end()) return;
    moves_.add(move);
  }

  template <int D>
  bool jump_man(Bits at, Bits captured, int n) {
    const Bits foe = B::template step<D>(at) & foes_ & ~captured;
    const Bits landing = B::template step<D>(foe) & open_;
    if (landing == 0) return false;
    step_man(landing, captured | foe, n + 1);
    return true;
  }

  void step_man(Bits at, Bits captured, int n) {
    bool more = false;
    if constexpr (R.men_capture_backwards || S == Side::light) {
      more |= jump_man<up_left>(at, captured, n);
      more |= jump_man<up_right>(at, captured, n);
    }
    if constexpr (R.men_capture_backwards || S == Side::dark) {
      more |= jump_man<down_left>(at, captured, n);
      more |= jump_man<down_right>(at, captured, n);
    }
    if (!more && n > 0) add(at, captured, n);
  }

  template <int D>
  bool jump_king(Bits at, Bits captured, int n) {
    const Bits foe = B::template step<D>(at) & foes_ & ~captured;
    const Bits landing = B::template step<D>(foe) & open_;
    if (landing == 0) return false;
    step_king(landing, captured | foe, n + 1);
    return true;
  }

  void step_king(Bits at, Bits captured, int n) {
    bool more = jump_king<up_left>(at, captured, n);
    more |= jump_king<up_right>(at, captured, n);
    more |= jump_king<down_left>(at, captured, n);
    more |= jump_king<down_right>(at, captured, n);
    if (!more && n > 0) add(at, captured, n);
  }

  // Flying kings only exist with the majority rule here, so that ends which could go on are dropped by `add`.
  template <int D>
  void fly(Bits at, Bits captured, int n) {
    static_assert(R.majority || !R.flying_kings);
    Bits foe = B::template step<D>(at);
    while ((foe & open_) != 0) foe = B::template step<D>(foe);
    if ((foe & foes_ & ~captured) == 0) return;
    const Bits first = B::template step<D>(foe) & open_;
    if (first == 0) return;
    captured |= foe;
    ++n;
    fly<D>(first, captured, n);
    for (Bits landing = first; (landing & open_) != 0; landing = B::template step<D>(landing)) {
      fly<(D ^ 1)>(landing, captured, n);
      fly<(D ^ 2)>(landing, captured, n);
      add(landing, captured, n);
    }
  }

  Bits foes_;
  Bits open_;
  MoveList& moves_;
  std::uint8_t from_ = 0;
  int most_ = 0;
};

template <const Rules& R, Side S>
void captures_of(const View& v, Bits men, Bits kings, MoveList& moves) {
  CaptureSearch<R, S> search(v, moves);
  for (Bits rest = men; rest != 0; rest &= rest - 1) search.man(rest & (~rest + 1));
  for (Bits rest = kings; rest != 0; rest &= rest - 1) search.king(rest & (~rest + 1));
}

template <const Rules& R, Side S>
bool captures(const View& v, MoveList& moves) {
  const Bits men = jumping_men<R, S>(v);
  const Bits kings = v.kings == 0 ? 0 : jumping_kings<R>(v);
  if ((men | kings) == 0) return false;
  captures_of<R, S>(v, men, kings, moves);
  return true;
}

template <const Rules& R, int D>
void quiet_men(const View& v, MoveList& moves) {
  constexpr int step = Board<R>::steps[D];
  for (Bits to = shifted<step>(v.men) & v.open; to != 0; to &= to - 1) {
    const int bit = lowest(to);
    moves.add({0, static_cast<std::uint8_t>(bit - step), static_cast<std::uint8_t>(bit)});
  }
}

template <const Rules& R, int D>
void quiet_king(Bits king, const View& v, MoveList& moves) {
  using B = Board<R>;
  const auto from = static_cast<std::uint8_t>(lowest(king));
  for (Bits to = B::template step<D>(king); (to & v.open) != 0; to = B::template step<D>(to)) {
    moves.add({0, from, static_cast<std::uint8_t>(lowest(to))});
    if constexpr (!R.flying_kings) break;
  }
}

template <const Rules& R, Side S>
void quiet(const View& v, MoveList& moves) {
  quiet_men<R, S == Side::light ? up_left : down_left>(v, moves);
  quiet_men<R, S == Side::light ? up_right : down_right>(v, moves);
  for (Bits rest = v.kings; rest != 0; rest &= rest - 1) {
    const Bits king = rest & (~rest + 1);
    quiet_king<R, up_left>(king, v, moves);
    quiet_king<R, up_right>(king, v, moves);
    quiet_king<R, down_left>(king, v, moves);
    quiet_king<R, down_right>(king, v, moves);
  }
}

template <const Rules& R, int D>
int reach(Bits king, Bits open) {
  using B = Board<R>;
  int n = 0;
  for (Bits to = B::template step<D>(king); (to & open) != 0; to = B::template step<D>(to)) {
    ++n;
    if constexpr (!R.flying_kings) break;
  }
  return n;
}

template <const Rules& R, Side S>
int count_quiet(const View& v) {
  using B = Board<R>;
  int n = std::popcount(B::template step < S == Side::light ? up_left : down_left > (v.men) & v.open) +
          std::popcount(B::template step < S == Side::light ? up_right : down_right > (v.men) & v.open);
  for (Bits rest = v.kings; rest != 0; rest &= rest - 1) {
    const Bits king = rest & (~rest + 1);
    n += reach<R, up_left>(king, v.open) + reach<R, up_right>(king, v.open) + reach<R, down_left>(king, v.open) +
         reach<R, down_right>(king, v.open);
  }
  return n;
}

template <const Rules& R, Side S>
Position played(const Position& p, const Move& move) {
  const Bits from = one(move.from);
  const Bits to = one(move.to);
  constexpr Bits far = S == Side::light ? Board<R>::L::top : Board<R>::L::bottom;
  const Bits crowned = ((p.kings & from) != 0 || (to & far) != 0) ? to : 0;
  Position q = p;
  Bits& mine = S == Side::light ? q.light : q.dark;
  Bits& theirs = S == Side::light ? q.dark : q.light;
  mine = (mine & ~from) | to;
  theirs &= ~move.captured;
  q.kings = (q.kings & ~(from | move.captured)) | crowned;
  q.turn = other(S);
  return q;
}

template <const Rules& R, Side S>
std::uint64_t count_leaves(const Position& p, int depth) {
  const View v = view_of<R, S>(p);
  const Bits men = jumping_men<R, S>(v);
  const Bits kings = v.kings == 0 ? 0 : jumping_kings<R>(v);
  MoveList moves;
  if ((men | kings) != 0) {
    captures_of<R, S>(v, men, kings, moves);
    if (depth == 1) return static_cast<std::uint64_t>(moves.size());
  } else {
    if (depth == 1) return static_cast<std::uint64_t>(count_quiet<R, S>(v));
    quiet<R, S>(v, moves);
  }
  std::uint64_t sum = 0;
  for (const Move& move : moves) sum += count_leaves<R, other(S)>(played<R, S>(p, move), depth - 1);
  return sum;
}

// Calls visit.template operator()<rules, side>() for the rules and the side to move.
template <const Rules& R, class Visit>
decltype(auto) with_side(Side side, Visit&& visit) {
  return side == Side::light ? visit.template operator()<R, Side::light>() : visit.template operator()<R, Side::dark>();
}

template <class Visit>
decltype(auto) dispatch(const Rules& rules, Side side, Visit&& visit) {
  switch (rules.id) {
    case RulesId::brazilian:
      return with_side<brazilian_rules>(side, visit);
    case RulesId::english:
      return with_side<english_rules>(side, visit);
    case RulesId::international:
      break;
  }
  return with_side<international_rules>(side, visit);
}

}  // namespace

void generate(const Rules& rules, const Position& position, MoveList& moves) {
  moves.clear();
  dispatch(rules, position.turn, [&]<const Rules & R, Side S>() {
    const View v = view_of<R, S>(position);
    if (!captures<R, S>(v, moves)) quiet<R, S>(v, moves);
  });
}

void generate_captures(const Rules& rules, const Position& position, MoveList& moves) {
  moves.clear();
  dispatch(rules, position.turn, [&]<const Rules & R, Side S>() { captures<R, S>(view_of<R, S>(position), moves); });
}

void generate_quiet(const Rules& rules, const Position& position, MoveList& moves) {
  moves.clear();
  dispatch(rules, position.turn, [&]<const Rules & R, Side S>() { quiet<R, S>(view_of<R, S>(position), moves); });
}

bool can_capture(const Rules& rules, const Position& position) {
  return dispatch(rules, position.turn, [&]<const Rules & R, Side S>() {
    const View v = view_of<R, S>(position);
    return jumping_men<R, S>(v) != 0 || (v.kings != 0 && jumping_kings<R>(v) != 0);
  });
}

bool has_quiet_move(const Rules& rules, const Position& position) {
  return dispatch(rules, position.turn,
                  [&]<const Rules & R, Side S>() { return count_quiet<R, S>(view_of<R, S>(position)) > 0; });
}

bool has_move(const Rules& rules, const Position& position) {
  return can_capture(rules, position) || has_quiet_move(rules, position);
}

Position after(const Rules& rules, const Position& position, const Move& move) {
  return dispatch(rules, position.turn, [&]<const Rules & R, Side S>() { return played<R, S>(position, move); });
}

std::uint64_t perft(const Rules& rules, const Position& position, int depth) {
  if (depth <= 0) return 1;
  return dispatch(rules, position.turn, [&]<const Rules & R, Side S>() { return count_leaves<R, S>(position, depth); });
}

}  // namespace counterpart
