#include "game_controller/engine/endgame.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "game_controller/engine/endgame_index.hpp"
#include "game_controller/engine/endgame_solve.hpp"

namespace counterpart {
namespace {

const EndgameIndex& index_for(const Rules& rules) {
  static const EndgameIndex ten(international_rules);
  static const EndgameIndex eight(brazilian_rules);
  return rules.squares == 10 ? ten : eight;
}

// What a move may turn this material into.
std::vector<Material> leads_to(const Material& m) {
  std::vector<Material> next;
  for (const Material& side : {m, m.turned()}) {
    if (side.light_men > 0) {
      Material crowned = side;
      --crowned.light_men;
      ++crowned.light_kings;
      next.push_back(crowned);
    }
    for (int men = 0; men <= side.dark_men; ++men) {
      for (int kings = 0; kings <= side.dark_kings; ++kings) {
        if (men + kings == 0) continue;
        Material fewer = side;
        fewer.dark_men -= men;
        fewer.dark_kings -= kings;
        next.push_back(fewer);
        if (fewer.light_men > 0) {
          --fewer.light_men;
          ++fewer.light_kings;
          next.push_back(fewer);
        }
      }
    }
  }
  return next;
}

}  // namespace

Material material_of(const Position& p) {
  return {std::popcount(p.light & ~p.kings), std::popcount(p.light & p.kings), std::popcount(p.dark & ~p.kings),
          std::popcount(p.dark & p.kings)};
}

std::vector<Material> endgame_materials(int most_pieces) {
  std::vector<Material> all;
  const int n = most_pieces;
  for (int light_men = 0; light_men <= n; ++light_men) {
    for (int light_kings = 0; light_men + light_kings <= n; ++light_kings) {
      for (int dark_men = 0; light_men + light_kings + dark_men <= n; ++dark_men) {
        for (int dark_kings = 0; light_men + light_kings + dark_men + dark_kings <= n; ++dark_kings) {
          const Material m{light_men, light_kings, dark_men, dark_kings};
          if (m.both_sides() && std::find(all.begin(), all.end(), m.turned()) == all.end()) all.push_back(m);
        }
      }
    }
  }
  // Captures leave fewer pieces and crowning fewer men.
  std::stable_sort(all.begin(), all.end(), [](const Material& a, const Material& b) {
    return a.pieces() != b.pieces() ? a.pieces() < b.pieces() : a.men() < b.men();
  });
  return all;
}

std::size_t EndgameTables::number_of(const Material& m) {
  return static_cast<std::size_t>(((m.light_men * 5 + m.light_kings) * 5 + m.dark_men) * 5 + m.dark_kings);
}

std::optional<EndgameValue> EndgameTables::find(const Position& position) const {
  if (std::popcount(position.light | position.dark) > most_pieces) return std::nullopt;
  const EndgameIndex& index = index_for(*rules_);
  const Position p = index.with_light_to_move(position);
  const EndgameBytes* bytes = table(material_of(p));
  if (bytes == nullptr) return std::nullopt;
  const int value = (*bytes)[index.of(p)];
  if (value == 0) return EndgameValue{};
  return EndgameValue{value % 2 == 0 ? 1 : -1, value - 1};
}

bool EndgameTables::make(const Material& m, const std::function<bool()>& give_up) {
  if (!m.both_sides() || m.pieces() > most_pieces) return false;
  if (has(m)) return true;
  for (const Material& next : leads_to(m)) {
    if (next.both_sides() && !make(next, give_up)) return false;
  }
  const std::lock_guard lock(making_);
  if (has(m)) return true;  // another thread was quicker
  auto solved = solve_endgame(*this, index_for(*rules_), m, give_up);
  if (!solved) return false;
  keep(m, std::move(solved->bytes));
  if (m != m.turned()) keep(m.turned(), std::move(solved->turned_bytes));
  return true;
}

bool EndgameTables::add(const Material& m, EndgameBytes bytes) {
  if (!m.both_sides() || m.pieces() > most_pieces || bytes.size() != index_for(*rules_).positions_of(m)) return false;
  const std::lock_guard lock(making_);
  if (!has(m)) keep(m, std::move(bytes));
  return true;
}

void EndgameTables::keep(const Material& m, EndgameBytes bytes) {
  owned_.push_back(std::make_unique<const EndgameBytes>(std::move(bytes)));
  tables_[number_of(m)].store(owned_.back().get(), std::memory_order_release);
}

}  // namespace counterpart
