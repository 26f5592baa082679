#include "game_controller/links/dxp_partner.hpp"

#include "game_controller/links/dxp_game.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

constexpr double patience_with_connecting_s = 10;
constexpr int minutes_asked_for = 60;

std::optional<Move> move_between(const Position& from, const Position& to) {
  MoveList legal;
  generate(international_rules, from, legal);
  for (const Move& move : legal) {
    if (after(international_rules, from, move) == to) return move;
  }
  return std::nullopt;
}

}  // namespace

Result<DxpPartner> DxpPartner::connect(const std::string& address, double patience_s) {
  auto channel = connect_to(address, patience_with_connecting_s);
  if (!channel) return tl::make_unexpected(channel.error());
  return DxpPartner(std::move(*channel), patience_s);
}

DxpPartner::~DxpPartner() {
  if (channel_.is_open()) static_cast<void>(say(DxpGameEnd{0, true}));
}

Result<Move> DxpPartner::ask(const Position& position, const std::function<bool()>& give_up) {
  if (auto led = lead_to(position, give_up); !led) return tl::make_unexpected(led.error());
  asked_ = position;
  while (true) {
    const auto message = hear(give_up);
    if (!message) return tl::make_unexpected(message.error());
    if (const auto* told = std::get_if<DxpMove>(&*message)) {
      const auto move = legal_dxp_move(position, *told);
      if (!move) return failure(ErrorCode::invalid_argument, "The distant player made an illegal move.");
      asked_.reset();
      left_ = after(international_rules, position, *move);
      return *move;
    }
    if (const auto* end = std::get_if<DxpGameEnd>(&*message)) {
      static_cast<void>(say(DxpGameEnd{0, end->stop}));
      in_game_ = false;
      return failure(ErrorCode::closed, "The distant player has ended the game.");
    }
    if (std::holds_alternative<DxpBackRequest>(*message)) static_cast<void>(say(DxpBackAccept{1}));
  }
}

Result<void> DxpPartner::lead_to(const Position& position, const std::function<bool()>& give_up) {
  if (in_game_ && asked_ == position) return {};
  if (in_game_ && !asked_ && left_) {
    if (const auto move = move_between(*left_, position)) return say(dxp_move(*move, 0));
  }
  if (in_game_) {
    if (auto ended = end_game(give_up); !ended) return ended;
  }
  return begin_game(position, give_up);
}

Result<void> DxpPartner::begin_game(const Position& position, const std::function<bool()>& give_up) {
  DxpGameRequest request;
  request.name = "Counterpart";
  request.follower_side = position.turn;
  request.minutes = minutes_asked_for;
  if (!(position == start_position(international_rules))) {
    request.position = write_hub_position(international_rules, position);
  }
  if (auto said = say(request); !said) return said;
  while (true) {
    const auto message = hear(give_up);
    if (!message) return tl::make_unexpected(message.error());
    const auto* answer = std::get_if<DxpGameAccept>(&*message);
    if (answer == nullptr) continue;
    if (answer->code != 0) return failure(ErrorCode::refused, "\"" + answer->name + "\" will not play such a game.");
    in_game_ = true;
    asked_.reset();
    left_.reset();
    return {};
  }
}

// A last move of its own may cross our message.
Result<void> DxpPartner::end_game(const std::function<bool()>& give_up) {
  if (auto said = say(DxpGameEnd{0, false}); !said) return said;
  while (true) {
    const auto message = hear(give_up);
    if (!message) return tl::make_unexpected(message.error());
    if (std::holds_alternative<DxpGameEnd>(*message)) break;
  }
  in_game_ = false;
  return {};
}

Result<void> DxpPartner::say(const DxpMessage& message) {
  return channel_.send(write_dxp(message) + '\0');
}

Result<DxpMessage> DxpPartner::hear(const std::function<bool()>& give_up) {
  const auto text = channel_.receive('\0', longest_dxp_message + 2, patience_s_, give_up);
  if (!text) return tl::make_unexpected(text.error());
  return read_dxp(*text);
}

}  // namespace counterpart
