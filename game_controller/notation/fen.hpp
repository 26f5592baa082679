// Positions as text: FEN as in PDN 3.0, and Hub's turn and squares.
#pragma once

#include <string>
#include <string_view>

#include "game_controller/rules/position.hpp"
#include "game_controller/rules/rules.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// "W:W31-50:B1-20": side to move, then colour and squares, K before kings; ranges, blanks and one trailing dot are
// accepted. Fails with line and column for what cannot be read, squares off the board or taken twice.
[[nodiscard]] Result<Position> read_fen(const Rules& rules, std::string_view text);

// The same, without ranges: "W:W31,32:B1,K20".
std::string write_fen(const Rules& rules, const Position& position);

// One of "wbWBe" a square, in order of number.
[[nodiscard]] Result<Position> read_squares(const Rules& rules, std::string_view squares, Side turn);
std::string write_squares(const Rules& rules, const Position& position);

// Hub: the turn (W or B) and then the squares.
[[nodiscard]] Result<Position> read_hub_position(const Rules& rules, std::string_view text);
std::string write_hub_position(const Rules& rules, const Position& position);

// The usual start.
Position start_position(const Rules& rules);

}  // namespace counterpart
