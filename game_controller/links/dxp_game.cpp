#include "game_controller/links/dxp_game.hpp"

#include <chrono>
#include <optional>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"
#include "game_controller/rules/routes.hpp"

namespace counterpart {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double patience_with_farewell_s = 5;
constexpr std::size_t longest_game_plies = 2'000;

Result<void> send(Channel& channel, const DxpMessage& message) {
  return channel.send(write_dxp(message) + '\0');
}

Result<DxpMessage> receive(Channel& channel, double timeout_s, const std::function<bool()>& give_up) {
  const auto text = channel.receive('\0', longest_dxp_message + 2, timeout_s, give_up);
  if (!text) return tl::make_unexpected(text.error());
  return read_dxp(*text);
}

}  // namespace

std::optional<Move> legal_dxp_move(const Position& position, const DxpMove& told) {
  if (told.from < 1 || told.from > 50 || told.to < 1 || told.to > 50) return std::nullopt;
  Bits captured = 0;
  for (const int square : told.captured) {
    if (square < 1 || square > 50) return std::nullopt;
    captured |= square_mask(square, international_rules.squares);
  }
  const auto from = static_cast<std::uint8_t>(bit_of_square(told.from, international_rules.squares));
  const auto to = static_cast<std::uint8_t>(bit_of_square(told.to, international_rules.squares));
  MoveList legal;
  generate(international_rules, position, legal);
  for (const Move& move : legal) {
    if (move == Move{captured, from, to}) return move;
  }
  return std::nullopt;
}

DxpMove dxp_move(const Move& move, int seconds) {
  return {seconds, square_of_bit(move.from, international_rules.squares),
          square_of_bit(move.to, international_rules.squares),
          squares_of_bits(move.captured, international_rules.squares)};
}

namespace {

GameResult win_of(Side side) {
  return side == Side::light ? GameResult::light_wins : GameResult::dark_wins;
}

class DxpGame {
 public:
  DxpGame(Channel& channel, const DxpPlayer& player, Record record, Side our_side, int minutes, int moves,
          std::string peer)
      : channel_(channel), player_(player), minutes_(minutes), moves_(moves), game_{std::move(record),
                                                                                    GameResult::open,
                                                                                    our_side,
                                                                                    std::move(peer),
                                                                                    "",
                                                                                    false} {}

  DxpResult play() {
    while (!over_) {
      if (game_.record.position().turn == game_.our_side) {
        our_turn();
      } else {
        their_turn();
      }
    }
    return std::move(game_);
  }

 private:
  void our_turn() {
    if (const auto ending = game_.record.ending()) {
      const int reason = ending->result == GameResult::draw ? 2 : 1;
      return say_end(ending->result, ending->code, reason);
    }
    if (game_.record.moves().size() >= longest_game_plies) return say_end(GameResult::draw, "too_long", 2);
    const auto start = Clock::now();
    const Move move = player_.choose(game_.record, minutes_, moves_);
    if (player_.give_up && player_.give_up()) return finish(GameResult::open, "stopped", true);
    const auto seconds = static_cast<int>(std::chrono::duration<double>(Clock::now() - start).count());
    if (!send(channel_, dxp_move(move, seconds))) return finish(win_of(game_.our_side), "closed", true);
    play(move);
  }

  void their_turn() {
    const auto message = receive(channel_, player_.patience_s, player_.give_up);
    if (!message) return lost_contact(message.error());
    if (const auto* move = std::get_if<DxpMove>(&*message)) {
      const auto legal = legal_dxp_move(game_.record.position(), *move);
      if (!legal) return say_end(win_of(game_.our_side), "illegal_move", 3);
      play(*legal);
    } else if (const auto* end = std::get_if<DxpGameEnd>(&*message)) {
      their_end(*end);
    } else if (const auto* chat = std::get_if<DxpChat>(&*message)) {
      if (player_.on_chat) player_.on_chat(chat->text);
    } else if (std::holds_alternative<DxpBackRequest>(*message)) {
      static_cast<void>(send(channel_, DxpBackAccept{1}));
    }  // nothing else has a meaning during a game
  }

  void their_end(const DxpGameEnd& end) {
    static_cast<void>(send(channel_, DxpGameEnd{0, end.stop}));
    const auto ending = game_.record.ending();
    if (ending) return finish(ending->result, ending->code, end.stop);
    if (end.reason == 1) return finish(win_of(game_.our_side), "resigned", end.stop);
    if (end.reason == 2) return finish(GameResult::draw, "agreed", end.stop);
    if (end.reason == 3) return finish(win_of(other(game_.our_side)), "claimed", end.stop);
    finish(GameResult::open, "ended", end.stop);
  }

  void lost_contact(const Error& error) {
    if (const auto ending = game_.record.ending()) return finish(ending->result, ending->code, true);
    if (error.code == ErrorCode::refused) return finish(GameResult::open, "stopped", true);
    const char* why = error.code == ErrorCode::timeout  ? "timeout"
                      : error.code == ErrorCode::closed ? "closed"
                                                        : "bad_message";
    finish(win_of(game_.our_side), why, true);
  }

  // Ours to say; the other side answers, and a last message of its own may cross ours.
  void say_end(GameResult result, const std::string& why, int reason) {
    bool stop = !send(channel_, DxpGameEnd{reason, false});
    while (!stop) {
      const auto answer = receive(channel_, patience_with_farewell_s, player_.give_up);
      if (!answer) {
        stop = true;
      } else if (const auto* end = std::get_if<DxpGameEnd>(&*answer)) {
        stop = end->stop;
        break;
      }
    }
    finish(result, why, stop);
  }

  void finish(GameResult result, const std::string& why, bool stop) {
    game_.result = result;
    game_.why = why;
    game_.stop = stop;
    over_ = true;
  }

  void play(const Move& move) {
    game_.record.play(move);
    if (player_.on_move) player_.on_move(game_.record, game_.our_side, game_.peer);
  }

  Channel& channel_;
  const DxpPlayer& player_;
  int minutes_;
  int moves_;
  DxpResult game_;
  bool over_ = false;
};

Result<Position> position_of(const DxpGameRequest& request) {
  return request.position.empty() ? Result<Position>(start_position(international_rules))
                                  : read_hub_position(international_rules, request.position);
}

}  // namespace

Result<DxpResult> ask_for_dxp_game(Channel& channel, const DxpGameRequest& request, const DxpPlayer& player) {
  const auto start = position_of(request);
  if (!start) return tl::make_unexpected(start.error());
  if (auto sent = send(channel, request); !sent) return tl::make_unexpected(sent.error());
  while (true) {
    const auto message = receive(channel, player.patience_s, player.give_up);
    if (!message) return tl::make_unexpected(message.error());
    const auto* answer = std::get_if<DxpGameAccept>(&*message);
    if (answer == nullptr) continue;
    if (answer->code != 0) {
      constexpr const char* reasons[] = {"", "it speaks another version", "it does not play such a game",
                                         "it plays no games"};
      return failure(ErrorCode::refused, "\"" + answer->name + "\" will not play: " +
                                             (answer->code <= 3 ? reasons[answer->code] : "it did not say why") + ".");
    }
    return DxpGame(channel, player, Record(international_rules, *start), other(request.follower_side), request.minutes,
                   request.moves, answer->name)
        .play();
  }
}

Result<DxpResult> answer_dxp_game(Channel& channel, const DxpPlayer& player) {
  while (true) {
    const auto message = receive(channel, player.patience_s, player.give_up);
    if (!message) return tl::make_unexpected(message.error());
    if (const auto* end = std::get_if<DxpGameEnd>(&*message); end != nullptr && end->stop) {
      static_cast<void>(send(channel, DxpGameEnd{0, true}));
      return failure(ErrorCode::closed, "The other program wants no further game.");
    }
    const auto* request = std::get_if<DxpGameRequest>(&*message);
    if (request == nullptr) continue;
    const auto start = position_of(*request);
    if (auto sent = send(channel, DxpGameAccept{player.name, start ? 0 : 2}); !sent) {
      return tl::make_unexpected(sent.error());
    }
    if (!start) continue;
    return DxpGame(channel, player, Record(international_rules, *start), request->follower_side, request->minutes,
                   request->moves, request->name)
        .play();
  }
}

}  // namespace counterpart
