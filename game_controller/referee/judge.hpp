// Was that a legal move, and if not, why not?
//
// Several things can be wrong at once. The reason given is the first of these that holds, from what nobody could mean
// to what only the finer rules forbid:
//   1. light_square        something stands where nothing may stand
//   2. (legal)             the board is as a legal move leaves it
//   3. no_change
//   4. piece_appeared      a side has more pieces on new squares than it has left old ones
//   5. not_your_turn       only the other side has moved;  opponent_piece_moved: it has moved as well
//   6. piece_vanished      pieces are missing and nothing has moved to a new square
//   7. two_pieces_moved
//   8. one piece has moved and another of the mover's own is gone: extra_piece_removed after a right capture,
//      jumped_own_piece if it was jumped, else piece_vanished
//   9. one piece has moved and nothing else of the mover's own: what the capture was meant to be decides
//      a. a legal move but for a crown: not_crowned, crowned_wrongly
//      b. captures that are possible but not enough: capture_not_finished (it goes on), not_maximum (it ends there)
//      c. captures that become possible only when a jumped piece leaves at once: piece_jumped_twice
//      d. the right landing with the wrong pieces off: captured_left_on_board (some are still there),
//         extra_piece_removed (more are gone), wrong_piece_removed (others are gone)
//      e. the right pieces off with a landing that the piece cannot reach, or a landing on one of them: wrong_landing
//      f. a step that would be right if no capture were compulsory: must_capture; with pieces gone: piece_vanished
//      g. how the piece went: not_diagonal, moved_backwards, jumped_own_piece, moved_too_far, path_blocked
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "game_controller/rules/move.hpp"
#include "game_controller/rules/position.hpp"
#include "game_controller/rules/rules.hpp"
#include "protocol/vocabulary/board_geometry.hpp"

namespace counterpart {

struct Verdict {
  std::optional<Move> move;  // the legal move that was made; if empty, see the rest
  std::string reason;        // one of the codes above
  std::vector<int> squares;  // what the reason is about
};

// before: the last position. after: the whole board as seen, both sides (its turn is not used). strays: pieces seen on
// squares that are not played on.
Verdict judge(const Rules& rules, const Position& before, const Position& after, const std::vector<Cell>& strays);

// For a camera that sees only the pieces of the side to move: whether the other side's captured pieces are gone cannot
// be seen and is taken as done. Legal captures with the same ends cannot be told apart here: `matching_moves` gives
// all.
Verdict judge_own(const Rules& rules, const Position& before, Bits own_after, const std::vector<Cell>& strays);

// All legal moves that leave the mover's own pieces so.
std::vector<Move> matching_moves(const Rules& rules, const Position& before, Bits own_after);

// Hub notation, in order of the text; at most `most`.
std::vector<std::string> legal_moves_text(const Rules& rules, const Position& position, std::size_t most = 12);

}  // namespace counterpart
