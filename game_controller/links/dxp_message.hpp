// DamExchange (DXP) messages: 1 to 127 ASCII characters, each ended by a zero byte on the wire.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "protocol/vocabulary/game.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

inline constexpr std::size_t longest_dxp_message = 127;

struct DxpGameRequest {
  std::string name;                  // of him who asks, at most 32 characters
  Side follower_side = Side::light;  // of him who is asked
  int minutes = 0;                   // 0-999 for
  int moves = 0;                     // so many moves, 0: for the whole game
  std::string position;              // empty: the usual start; else the turn W or B and 50 of w b W B e, as in Hub
};

struct DxpGameAccept {
  std::string name;
  int code = 0;  // 0 accepted, 1 version, 2 not this game, 3 no games
};

struct DxpMove {
  int seconds = 0;  // that it took, 0-9999
  int from = 0;     // squares
  int to = 0;
  std::vector<int> captured;
};

struct DxpGameEnd {
  int reason = 0;     // 0 none, 1 I resign, 2 draw, 3 I win
  bool stop = false;  // no other game
};

struct DxpChat {
  std::string text;
};

struct DxpBackRequest {
  int move = 0;
  Side side = Side::light;
};

struct DxpBackAccept {
  int code = 0;  // 0 yes, 1 not supported, 2 no
};

using DxpMessage =
    std::variant<DxpGameRequest, DxpGameAccept, DxpMove, DxpGameEnd, DxpChat, DxpBackRequest, DxpBackAccept>;

// Without the zero byte; line breaks before it are skipped. Fails with the column.
[[nodiscard]] Result<DxpMessage> read_dxp(std::string_view text);

// Without the zero byte. Names and numbers are cut to what the layout holds.
std::string write_dxp(const DxpMessage& message);

}  // namespace counterpart
