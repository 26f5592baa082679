// A distant program or person, reached over DXP, as the finder of one side's moves.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "game_controller/links/channel.hpp"
#include "game_controller/links/dxp_message.hpp"
#include "game_controller/rules/move.hpp"
#include "game_controller/rules/position.hpp"

namespace counterpart {

class DxpPartner {
 public:
  // address: HOST:PORT where it listens.
  [[nodiscard]] static Result<DxpPartner> connect(const std::string& address, double patience_s = 600);
  ~DxpPartner();  // says goodbye
  DxpPartner(DxpPartner&&) noexcept = default;
  DxpPartner& operator=(DxpPartner&&) = delete;

  // International rules. Its move in a position where it is to move. If one legal move leads here from where it moved
  // last it is told that move, otherwise the game is ended and another asked for that begins here. Fails if it is gone,
  // silent beyond its patience, resigns, or its move is illegal; with `refused` when give_up says so: it may be asked
  // again then.
  [[nodiscard]] Result<Move> ask(const Position& position, const std::function<bool()>& give_up = {});

 private:
  DxpPartner(Channel channel, double patience_s) : channel_(std::move(channel)), patience_s_(patience_s) {}
  Result<void> say(const DxpMessage& message);
  Result<DxpMessage> hear(const std::function<bool()>& give_up);
  Result<void> lead_to(const Position& position, const std::function<bool()>& give_up);
  Result<void> begin_game(const Position& position, const std::function<bool()>& give_up);
  Result<void> end_game(const std::function<bool()>& give_up);

  Channel channel_;
  double patience_s_;
  bool in_game_ = false;
  std::optional<Position> asked_;  // it is thinking about this
  std::optional<Position> left_;   // its last move led here
};

}  // namespace counterpart
