// Moves as text.
#pragma once

#include <string>
#include <string_view>

#include "game_controller/rules/move.hpp"
#include "game_controller/rules/position.hpp"
#include "game_controller/rules/rules.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// PDN: "32-28", "28x19"; the whole path where that would be ambiguous ("47x38x24x13x36"). The move must be legal.
std::string pdn_text(const Rules& rules, const Position& position, const Move& move);

// The whole path always: "28x19x10".
std::string path_text(const Rules& rules, const Position& position, const Move& move);

// Hub: "32-28", "28x10x23x14": from, to, then the captured squares in order of number.
std::string hub_text(const Rules& rules, const Move& move);

// What three or more numbers mean when both readings are legal.
enum class MoveStyle { pdn, hub };

// The legal move that the text names: from-to, a path, a part of a path, or Hub's captured squares. Fails if the text
// is no move, the move is not legal, or two legal moves fit; the sentence names them.
[[nodiscard]] Result<Move> read_move(const Rules& rules, const Position& position, std::string_view text,
                                     MoveStyle style = MoveStyle::pdn);

}  // namespace counterpart
