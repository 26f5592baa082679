#include "game_controller/engine/endgame_solve.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

constexpr int highest_value = 255;

// How many moves of a position still may hold it, or that its value does not depend on their number.
constexpr std::uint8_t no_quiet_moves = 255;  // captures, which lead elsewhere; or no position at all
constexpr std::uint8_t cannot_lose = 254;     // a move that leads elsewhere draws or wins

struct CutShort {};

struct Half {  // one of the two tables in work
  Material material;
  EndgameBytes value;
  std::vector<std::uint8_t> holding_moves;
  std::vector<std::uint8_t> longest_loss;  // by a move that has been found to lose
};

struct Entry {
  std::uint32_t side;
  std::uint32_t index;
};

// A material and its turned one lead to each other by quiet moves; all other moves lead to what is known. Values are
// found in rising order, so that each win is the shortest and each loss the longest.
class Solver {
 public:
  Solver(const EndgameTables& known, const EndgameIndex& index, const Material& material,
         const std::function<bool()>& give_up)
      : known_(known), rules_(known.rules()), index_(index), give_up_(give_up) {
    sides_.push_back(side_of(material));
    if (material != material.turned()) sides_.push_back(side_of(material.turned()));
  }

  SolvedEndgame solve() {
    for (std::uint32_t side = 0; side < sides_.size(); ++side) {
      for (std::uint32_t i = 0; i < sides_[side].value.size(); ++i) begin({side, i});
    }
    for (int value = 1; value <= highest_value; ++value) {
      // The list grows only by higher values.
      for (const Entry entry : std::exchange(found_[static_cast<std::size_t>(value)], {})) settle(entry, value);
    }
    return {std::move(sides_[0].value), sides_.size() > 1 ? std::move(sides_[1].value) : EndgameBytes{}};
  }

 private:
  Half side_of(const Material& m) const {
    const std::size_t n = index_.positions_of(m);
    return {m, EndgameBytes(n, 0), std::vector<std::uint8_t>(n, 0), std::vector<std::uint8_t>(n, 0)};
  }

  std::uint32_t opposite(std::uint32_t side) const { return sides_.size() > 1 ? 1 - side : 0; }

  void look_at_clock() {
    if (++steps_ % 4096 == 0 && give_up_ && give_up_()) throw CutShort{};
  }

  void find(Entry entry, int value) {
    if (value <= highest_value) found_[static_cast<std::size_t>(value)].push_back(entry);
  }

  // What is known of a position from its moves that leave the two tables.
  void begin(Entry entry) {
    look_at_clock();
    Half& side = sides_[entry.side];
    std::uint8_t& holding = side.holding_moves[entry.index];
    const auto p = index_.position_at(side.material, entry.index);
    if (!p) {
      holding = no_quiet_moves;
      return;
    }
    MoveList moves;
    generate(rules_, *p, moves);
    if (moves.empty()) {
      holding = no_quiet_moves;
      return find(entry, 1);
    }
    int quickest_win = highest_value + 1;
    int longest_loss = 0;
    int staying = 0;
    bool draws = false;
    for (const Move& move : moves) {
      const Position q = after(rules_, *p, move);
      const bool stays = move.captured == 0 && std::popcount(q.kings) == std::popcount(p->kings);
      if (stays) {
        ++staying;
        continue;
      }
      const int theirs = value_elsewhere(q);
      if (theirs == 0) draws = true;
      if (theirs % 2 == 1) quickest_win = std::min(quickest_win, theirs + 1);
      if (theirs != 0 && theirs % 2 == 0) longest_loss = std::max(longest_loss, theirs + 1);
    }
    if (quickest_win <= highest_value) find(entry, quickest_win);
    const bool holds = draws || quickest_win <= highest_value;
    side.longest_loss[entry.index] = static_cast<std::uint8_t>(std::min(longest_loss, highest_value));
    holding = moves[0].captured != 0 ? no_quiet_moves : holds ? cannot_lose : static_cast<std::uint8_t>(staying);
    if (!holds && staying == 0) find(entry, longest_loss);
  }

  // As in a table, for who is to move there.
  int value_elsewhere(const Position& position) const {
    const Position q = index_.with_light_to_move(position);
    if (q.light == 0) return 1;
    const auto value = known_.find(q);
    if (!value) throw CutShort{};
    return value->outcome == 0 ? 0 : value->plies + 1;
  }

  void settle(Entry entry, int value) {
    look_at_clock();
    Half& side = sides_[entry.side];
    if (side.value[entry.index] != 0) return;
    side.value[entry.index] = static_cast<std::uint8_t>(value);
    const auto p = index_.position_at(side.material, entry.index);
    if (p) tell_those_before(*p, opposite(entry.side), value);
  }

  // Dark's quiet moves backwards. Light is to move in p.
  void tell_those_before(const Position& p, std::uint32_t side, int value) {
    const Bits open = all_squares(rules_.squares) & ~(p.light | p.dark);
    const int n = rules_.squares;
    for (Bits rest = p.dark; rest != 0; rest &= rest - 1) {
      const Bits piece = rest & (~rest + 1);
      const bool king = (p.kings & piece) != 0;
      for (const int step : {-(n / 2 + 1), -(n / 2), n / 2, n / 2 + 1}) {
        if (!king && step > 0) continue;  // dark's men have come from above
        for (Bits from = moved(piece, step); (from & open) != 0; from = moved(from, step)) {
          Position q = p;
          q.dark ^= piece | from;
          if (king) q.kings ^= piece | from;
          q.turn = Side::dark;
          tell({side, static_cast<std::uint32_t>(index_.of(index_.turned(q)))}, value);
          if (!king || !rules_.flying_kings) break;
        }
      }
    }
  }

  static Bits moved(Bits bits, int step) { return step > 0 ? bits << step : bits >> -step; }

  // A position has a quiet move to one of this value.
  void tell(Entry entry, int value) {
    Half& side = sides_[entry.side];
    std::uint8_t& holding = side.holding_moves[entry.index];
    if (holding == no_quiet_moves || side.value[entry.index] != 0) return;
    if (value % 2 == 1) {
      find(entry, value + 1);
    } else if (holding != cannot_lose) {
      std::uint8_t& longest = side.longest_loss[entry.index];
      longest = std::max(longest, static_cast<std::uint8_t>(std::min(value + 1, highest_value)));
      if (--holding == 0) find(entry, longest);
    }
  }

  const EndgameTables& known_;
  const Rules& rules_;
  const EndgameIndex& index_;
  const std::function<bool()>& give_up_;
  std::vector<Half> sides_;
  std::array<std::vector<Entry>, highest_value + 1> found_;
  std::uint64_t steps_ = 0;
};

}  // namespace

std::optional<SolvedEndgame> solve_endgame(const EndgameTables& known, const EndgameIndex& index,
                                           const Material& material, const std::function<bool()>& give_up) {
  try {
    return Solver(known, index, material, give_up).solve();
  } catch (const CutShort&) {
    return std::nullopt;
  }
}

}  // namespace counterpart
