// Inside of Game: what is remembered between frames, and the steps of the game.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "game_controller/game/choreographer.hpp"
#include "game_controller/game/game.hpp"
#include "game_controller/game/lost_pieces.hpp"
#include "game_controller/game/reading.hpp"
#include "game_controller/referee/judge.hpp"
#include "game_controller/rules/record.hpp"
#include "game_controller/rules/rules.hpp"

namespace counterpart {

// The virtual player's move between the engine's answer and the piece's landing.
struct PendingMove {
  Move move{};
  std::uint64_t grasp = 0;  // command id; 0: not told yet. If all pieces are real: of the pointing
  bool second_try = false;
  std::int64_t told_ns = 0;
};

struct Game::State {
  GameOptions options;
  const Rules* rules;
  Record record;
  std::map<int, std::string> names;  // of every piece, by the square it stands on
  LostPieces lost;                   // the virtual player's
  Choreographer human;

  GamePhase phase = GamePhase::setting_up;
  GamePhase behind = GamePhase::setting_up;  // where `illegal` and `paused` go back to
  GameResult result = GameResult::open;
  std::string result_code;
  bool started = false;
  bool thinking = false;  // the engine has been asked and has not answered
  bool ask_engine = false;
  std::optional<PendingMove> pending;
  Bits to_remove = 0;
  std::int64_t lost_told_ns = 0;  // since when his hands have been told to move lost pieces

  std::uint64_t revision = 0;
  std::uint64_t scene_revision = 0;
  std::uint64_t next_event = 1;
  BoardState shown;        // as last given out
  bool given_out = false;  // by this process

  // What the eyes have told. Not saved: after a restart one looks afresh.
  SteadyReading eyes;
  std::optional<Reading> announced;  // the wrong reading that was last complained about
  std::int64_t reminded_ns = 0;
  std::vector<Bits> stops;  // own pieces as seen in passing since the last position: the way of a capture

  std::vector<std::string> explained;  // rules that have been explained already

  std::int64_t now_ns = 0;
  GameOutputs out;

  State(const GameOptions& o, const Rules& r, const Position& start, std::uint64_t first_command);

  Side real_side() const { return other(options.virtual_side); }
  bool real_to_move() const { return record.position().turn == real_side(); }
  Bits real_pieces(const Position& p) const { return options.both_real ? p.light | p.dark : pieces_of(p, real_side()); }
  Bits real_pieces() const { return real_pieces(record.position()); }

  void step(const GameInputs& inputs);

  // Eyes.
  void look();
  void look_at_set_up(const Reading& reading);
  void look_for_move(const Reading& reading);
  void look_while_waiting(const Reading& reading);
  void look_for_favour(const Reading& reading);
  void look_for_removal(const Reading& reading);
  void look_at_wrong_board(const Reading& reading);
  std::vector<Move> fitting_moves(const Reading& reading) const;
  bool try_moves(const Reading& reading);
  Bits wrong_squares(const Reading& reading, const Position& expected) const;
  bool differs(const Reading& reading, const Position& expected) const;
  Verdict judge_reading(const Reading& reading) const;
  std::optional<Position> asked_for() const;
  bool nearly_all_seen(const Reading& reading) const;
  bool settled() const;
  bool reminding();
  void remember_stop(const Reading& reading);
  void report_unclear(Bits concerned);

  // Steps of the game.
  void begin();
  void commit(const Move& move);
  void hand_over();
  void finish(const Ending& ending);
  void object(const Reading& reading, const std::string& reason, const std::vector<int>& squares);
  void put_right();
  void ask_for_removal(bool again);
  void removal_done();
  void take_back();
  void restart(const Position& start);

  // The virtual player.
  void receive_engine_move(const std::string& text);
  void tell_move();
  void ask_to_move();
  void hear(const Feedback& feedback);
  void landed();
  void carry_lost();
  void set_lost_down();
  void renderer_joined();

  void obey(const Control& control);
  void it_was(const std::string& text);

  // Explaining.
  void hint(const std::string& about);  // "last": what was wrong with the real player's last move
  void explain_last();
  void explain_surprise(const Position& before, const Move& move, const Route& route);

  // Giving out.
  GameEvent& event(EventKind kind);
  std::vector<int> squares(Bits bits) const;
  BoardState board_state() const;
  Scene scene() const;
  void show_scene();
  void name_pieces();
  void move_names(const Position& before, const Move& move, const Route& route);
};

}  // namespace counterpart
