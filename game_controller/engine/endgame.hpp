// Endgame tables: for every position of a few pieces who wins and how soon, made by working back from the ends
// (retrograde analysis). The draw rules that count moves are left out.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "game_controller/rules/position.hpp"
#include "game_controller/rules/rules.hpp"

namespace counterpart {

struct EndgameValue {
  int outcome = 0;  // for the side to move: 1 wins, -1 loses, 0 neither
  int plies = 0;    // to the end with best play of both; 0 if neither wins
};

// How many men and kings each side has, where light is to move. Everything is seen so: the board is turned round and
// the colours are swapped when dark is to move.
struct Material {
  int light_men = 0;
  int light_kings = 0;
  int dark_men = 0;
  int dark_kings = 0;

  int pieces() const { return light_men + light_kings + dark_men + dark_kings; }
  int men() const { return light_men + dark_men; }
  bool both_sides() const { return light_men + light_kings > 0 && dark_men + dark_kings > 0; }
  Material turned() const { return {dark_men, dark_kings, light_men, light_kings}; }
  friend bool operator==(const Material&, const Material&) = default;
};

Material material_of(const Position& position);  // as it is, whoever is to move

// Every material of so many pieces at most, what it leads to before it; of a material and its turned one only one.
std::vector<Material> endgame_materials(int most_pieces);

// One byte a position: 0 neither wins, else plies to the end + 1, where the side to move has lost if they are even.
using EndgameBytes = std::vector<std::uint8_t>;

// Tables of one set of rules. They may be read by one thread while another adds to them.
class EndgameTables {
 public:
  static constexpr int most_pieces = 4;

  explicit EndgameTables(const Rules& rules) : rules_(&rules) {}

  const Rules& rules() const { return *rules_; }

  // Empty if a side has no piece, or the table is not there.
  std::optional<EndgameValue> find(const Position& position) const;

  bool has(const Material& material) const { return table(material) != nullptr; }

  // Makes the tables of a material, of its turned one and of all that they lead to, as far as they are not there.
  // give_up is asked often; when it says so nothing more is added. Says whether they are there. At most 4 pieces, both
  // sides.
  bool make(const Material& material, const std::function<bool()>& give_up = {});

  // For keeping them elsewhere; `add` takes what `bytes` gave, or says that the size is wrong.
  const EndgameBytes* bytes(const Material& material) const { return table(material); }
  bool add(const Material& material, EndgameBytes bytes);

 private:
  static constexpr std::size_t classes = 625;
  static std::size_t number_of(const Material& material);
  const EndgameBytes* table(const Material& material) const {
    return tables_[number_of(material)].load(std::memory_order_acquire);
  }
  void keep(const Material& material, EndgameBytes bytes);

  const Rules* rules_;
  std::array<std::atomic<const EndgameBytes*>, classes> tables_{};
  std::mutex making_;
  std::vector<std::unique_ptr<const EndgameBytes>> owned_;
};

}  // namespace counterpart
