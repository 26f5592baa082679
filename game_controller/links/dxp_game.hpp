// Games over DXP: with a distant program or person, one game after another on one connection.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "game_controller/links/channel.hpp"
#include "game_controller/links/dxp_message.hpp"
#include "game_controller/rules/record.hpp"

namespace counterpart {

struct DxpResult {
  Record record;
  GameResult result = GameResult::open;
  Side our_side = Side::light;
  std::string peer;   // its name
  std::string why;    // "no_moves", "repetition" ... , "resigned", "agreed", "illegal_move", "timeout", "closed"
  bool stop = false;  // the other side wants no further game, or is gone
};

// The legal move that a message tells; empty if there is none.
std::optional<Move> legal_dxp_move(const Position& position, const DxpMove& told);

DxpMove dxp_move(const Move& move, int seconds);

// What a game needs from us.
struct DxpPlayer {
  // Our move here, asked when it is our turn; minutes and moves are those of the request.
  std::function<Move(const Record& record, int minutes, int moves)> choose;
  std::function<void(const Record&, Side our_side, const std::string& peer)> on_move;  // after each move; may be empty
  std::function<void(const std::string& text)> on_chat;                                // may be empty
  std::function<bool()> give_up;                                                       // stop waiting? may be empty
  std::string name = "Counterpart";
  double patience_s = 600;  // for the other side's move
};

// International rules, the only ones that DXP knows. Errors that are the other side's fault end in a DxpResult: an
// illegal move, silence or a lost connection costs it the game.

// We ask for a game. Fails if the other side will not play.
[[nodiscard]] Result<DxpResult> ask_for_dxp_game(Channel& channel, const DxpGameRequest& request,
                                                 const DxpPlayer& player);

// We are asked. Fails with `closed` or `timeout` if no request comes within `patience_s`.
[[nodiscard]] Result<DxpResult> answer_dxp_game(Channel& channel, const DxpPlayer& player);

}  // namespace counterpart
