// The games as data: what differs between international, Brazilian and English draughts. Everything else is shared.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "protocol/vocabulary/game.hpp"

namespace counterpart {

enum class RulesId : std::uint8_t { international = 1, brazilian = 2, english = 3 };

// A lone king against a small force: a draw after so many moves by each side.
struct LoneKingLimit {
  int strong_pieces_min = 0;  // pieces of the stronger side, at least one of them a king
  int strong_pieces_max = 0;
  int moves_each = 0;
};

struct Rules {
  RulesId id;
  std::string_view name;
  int squares;                             // a side
  int rows_of_men;                         // at the start, each side
  Side first;                              // who moves first
  bool men_capture_backwards;              // FMJD Annex 1 art. 4.2; English men capture forwards only
  bool flying_kings;                       // art. 3.9 and 4.3; English kings move one square
  bool majority;                           // art. 4.13: the most pieces must be taken
  int repetitions;                         // art. 6.1: the same position so many times is a draw
  int kings_only_moves_each;               // art. 6.2: so many moves each without capture or man's move are a draw
  std::array<LoneKingLimit, 2> lone_king;  // art. 6.3 and 6.4; moves_each 0: no such rule
  std::string_view start_fen;
};

// FMJD Annex 1: 2.1 (board), 2.5 (numbers), 3 (moves), 4 (captures), 6 (draws).
inline constexpr Rules international_rules{
    RulesId::international,    "international", 10, 4, Side::light, true, true, true, 3, 25,
    {{{3, 3, 16}, {1, 2, 5}}}, "W:W31-50:B1-20"};

// CBD / FMJD-64: international rules on 32 squares; 20 moves of kings only (art. 94), and 15 and 5 moves for a lone
// king.
inline constexpr Rules brazilian_rules{
    RulesId::brazilian,        "brazilian",     8, 3, Side::light, true, true, true, 3, 20,
    {{{3, 3, 15}, {1, 2, 5}}}, "W:W21-32:B1-12"};

// WCDF rules: dark moves first (1.5), men capture forwards (1.17), kings move one square (1.16), any capture may be
// chosen (1.19), a man that reaches the far row stops there (1.18); 40 moves without progress are a draw (1.32).
inline constexpr Rules english_rules{
    RulesId::english,         "english",       8, 3, Side::dark, false, false, false, 3, 40,
    {{{0, 0, 0}, {0, 0, 0}}}, "B:W21-32:B1-12"};

// nullptr for a name that is none of the three.
const Rules* find_rules(std::string_view name);

}  // namespace counterpart
