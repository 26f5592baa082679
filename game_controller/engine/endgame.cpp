#include "game_controller/engine/endgame.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

constexpr int board_squares = 50;
constexpr int longest_win_plies = 250;
constexpr char mark[] = "counterpart endgames 1\n";

struct Material {
  int light_men = 0;
  int light_kings = 0;
  int dark_men = 0;
  int dark_kings = 0;

  int pieces() const { return light_men + light_kings + dark_men + dark_kings; }
  int men() const { return light_men + dark_men; }
  bool both_sides() const { return light_men + light_kings > 0 && dark_men + dark_kings > 0; }
  Material turned() const { return {dark_men, dark_kings, light_men, light_kings}; }
  std::size_t number() const {
    return static_cast<std::size_t>(((light_men * 4 + light_kings) * 4 + dark_men) * 4 + dark_kings);
  }
};

std::size_t positions_of(const Material& m) {
  std::size_t n = 1;
  for (int i = 0; i < m.pieces(); ++i) n *= board_squares;
  return n;
}

Bits turned(Bits bits) {
  Bits out = 0;
  for (; bits != 0; bits &= bits - 1) out |= one(53 - lowest(bits));
  return out;
}

Position with_light_to_move(const Position& p) {
  if (p.turn == Side::light) return p;
  return {turned(p.dark), turned(p.light), turned(p.kings), Side::light};
}

Material material_of(const Position& p) {
  return {std::popcount(p.light & ~p.kings), std::popcount(p.light & p.kings), std::popcount(p.dark & ~p.kings),
          std::popcount(p.dark & p.kings)};
}

std::size_t append(std::size_t index, Bits pieces) {
  for (; pieces != 0; pieces &= pieces - 1) {
    index = index * board_squares + static_cast<std::size_t>(square_of_bit(lowest(pieces), 10) - 1);
  }
  return index;
}

// Light to move. Pieces of a kind in order of their squares.
std::size_t index_of(const Position& p) {
  return append(append(append(append(0, p.light & ~p.kings), p.light & p.kings), p.dark & ~p.kings), p.dark & p.kings);
}

// Empty for an index that is no position, or is one that another index stands for.
std::optional<Position> position_at(const Material& m, std::size_t index) {
  std::array<int, EndgameTables::most_pieces> on{};
  const int n = m.pieces();
  for (int i = n - 1; i >= 0; --i) {
    on[static_cast<std::size_t>(i)] = static_cast<int>(index % board_squares) + 1;
    index /= board_squares;
  }
  Position p;
  std::size_t at = 0;
  const auto put = [&](int count, Bits& side, bool kings, Bits forbidden) {
    for (int i = 0; i < count; ++i, ++at) {
      const Bits bit = square_mask(on[at], 10);
      if (((p.light | p.dark | forbidden) & bit) != 0) return false;
      if (i > 0 && on[at] < on[at - 1]) return false;
      side |= bit;
      if (kings) p.kings |= bit;
    }
    return true;
  };
  if (put(m.light_men, p.light, false, Layout<10>::top) && put(m.light_kings, p.light, true, 0) &&
      put(m.dark_men, p.dark, false, Layout<10>::bottom) && put(m.dark_kings, p.dark, true, 0)) {
    return p;
  }
  return std::nullopt;
}

std::vector<Material> all_materials() {
  std::vector<Material> all;
  for (int code = 0; code < 256; ++code) {
    const Material m{code >> 6 & 3, code >> 4 & 3, code >> 2 & 3, code & 3};
    if (m.both_sides() && m.pieces() <= EndgameTables::most_pieces) all.push_back(m);
  }
  // Captures leave fewer pieces and crowning fewer men: what a class depends on comes before it.
  std::stable_sort(all.begin(), all.end(), [](const Material& a, const Material& b) {
    return a.pieces() != b.pieces() ? a.pieces() < b.pieces() : a.men() < b.men();
  });
  return all;
}

using Tables = std::array<std::vector<std::uint8_t>, 256>;

// The value of a position with light to move from those after its moves: 0 while it is not known.
std::uint8_t worked_back(const Tables& tables, const Position& p) {
  MoveList moves;
  generate(international_rules, p, moves);
  int best_win = 256;
  int longest_loss = 0;
  bool all_lose = true;
  for (const Move& move : moves) {
    const Position q = with_light_to_move(after(international_rules, p, move));
    // Plies + 1 of the other side; none left: it has lost at once.
    const int theirs = q.light == 0 ? 1 : tables[material_of(q).number()][index_of(q)];
    const bool they_lose = theirs % 2 == 1;
    if (they_lose) best_win = std::min(best_win, theirs + 1);
    if (theirs == 0 || they_lose) all_lose = false;
    longest_loss = std::max(longest_loss, theirs + 1);
  }
  if (best_win < 256) return static_cast<std::uint8_t>(best_win);
  if (moves.empty()) return 1;
  return all_lose ? static_cast<std::uint8_t>(longest_loss) : 0;
}

// A class and the one with the colours swapped, ply by ply, so that each value is the shortest.
void solve(Tables& tables, const Material& m) {
  struct Open {
    std::size_t number;
    std::size_t index;
    Position position;
  };
  std::vector<Open> open;
  for (const Material& side : {m, m.turned()}) {
    if (!tables[side.number()].empty()) continue;  // its own mirror image
    tables[side.number()].assign(positions_of(side), 0);
    for (std::size_t i = 0; i < positions_of(side); ++i) {
      if (const auto p = position_at(side, i)) open.push_back({side.number(), i, *p});
    }
  }
  int deepest_before = 0;  // of the classes that this one leads to
  for (const auto& table : tables) {
    for (const std::uint8_t value : table) deepest_before = std::max<int>(deepest_before, value);
  }
  int idle = 0;
  for (int value = 1; value <= longest_win_plies && (idle < 2 || value <= deepest_before + 2); ++value) {
    std::vector<Open> found;
    const auto now = [&](const Open& o) {
      if (worked_back(tables, o.position) != value) return false;
      found.push_back(o);
      return true;
    };
    open.erase(std::remove_if(open.begin(), open.end(), now), open.end());
    for (const Open& o : found) tables[o.number][o.index] = static_cast<std::uint8_t>(value);
    idle = found.empty() ? idle + 1 : 0;
  }
}

std::filesystem::path cache_file() {
  const char* cache = std::getenv("COUNTERPART_CACHE");
  const char* home = std::getenv("HOME");
  std::filesystem::path folder =
      cache != nullptr ? cache : std::string(home != nullptr ? home : ".") + "/.cache/counterpart";
  return folder / "endgames" / "international_3.bin";
}

}  // namespace

EndgameTables EndgameTables::generate() {
  EndgameTables result;
  for (const Material& m : all_materials()) {
    if (result.tables_[m.number()].empty()) solve(result.tables_, m);
  }
  return result;
}

std::optional<EndgameValue> EndgameTables::find(const Position& position) const {
  if (std::popcount(position.light | position.dark) > most_pieces || position.light == 0 || position.dark == 0) {
    return std::nullopt;
  }
  const Position p = with_light_to_move(position);
  const auto& table = tables_[material_of(p).number()];
  const std::size_t index = index_of(p);
  if (index >= table.size()) return std::nullopt;
  const int value = table[index];
  if (value == 0) return EndgameValue{};
  return EndgameValue{value % 2 == 0 ? 1 : -1, value - 1};
}

Result<void> EndgameTables::save(const std::string& file) const {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << mark;
  for (const auto& table : tables_) {
    out.write(reinterpret_cast<const char*>(table.data()), static_cast<std::streamsize>(table.size()));
  }
  out.flush();
  if (!out) return failure(ErrorCode::io, "The endgame tables could not be written to " + file + ".");
  return {};
}

Result<EndgameTables> EndgameTables::load(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string first;
  if (!in || !std::getline(in, first) || first + "\n" != mark) {
    return failure(ErrorCode::not_found, "There are no endgame tables in " + file + ".");
  }
  EndgameTables result;
  for (std::size_t code = 0; code < classes; ++code) {
    const Material m{static_cast<int>(code >> 6 & 3), static_cast<int>(code >> 4 & 3), static_cast<int>(code >> 2 & 3),
                     static_cast<int>(code & 3)};
    if (!m.both_sides() || m.pieces() > most_pieces) continue;
    auto& table = result.tables_[code];
    table.resize(positions_of(m));
    in.read(reinterpret_cast<char*>(table.data()), static_cast<std::streamsize>(table.size()));
  }
  if (!in || in.peek() != std::ifstream::traits_type::eof()) {
    return failure(ErrorCode::bad_format, "The endgame tables in " + file + " are damaged; delete the file.");
  }
  return result;
}

EndgameTables EndgameTables::load_or_generate() {
  const std::filesystem::path file = cache_file();
  if (auto cached = load(file.string())) return std::move(*cached);
  EndgameTables fresh = generate();
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  // Under another name first: two programs may do this at once.
  const std::string part = file.string() + ".part" + std::to_string(std::rand());
  if (fresh.save(part)) std::filesystem::rename(part, file, ignored);
  return fresh;
}

}  // namespace counterpart
