// One game, from what the camera reads to what the virtual human is told: the referee, the turn order and the
// choreographer behind one step function. It knows no clock, no network, no picture: time and everything else is an
// argument.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/vocabulary/command.hpp"
#include "protocol/vocabulary/game.hpp"
#include "protocol/vocabulary/occupancy.hpp"
#include "protocol/vocabulary/result.hpp"
#include "protocol/vocabulary/scene.hpp"

namespace counterpart {

struct GameOptions {
  std::string rules = "international";  // "international", "brazilian", "english"
  Side virtual_side = Side::light;      // the paper's cast: the virtual player has the light pieces
  bool both_real = false;               // his pieces are real too: he asks the real player to move them for him
  std::string start_fen;                // empty: the usual start
  BoardGeometry board;                  // for the places of pieces
  double table_height_m = 0.74;
  std::int64_t stable_ns = 200'000'000;  // a reading counts when it has not changed for so long
  std::int64_t settle_ns =
      1'200'000'000;  // an illegal position is announced when it has stood for so long (people move in steps)
  std::int64_t remind_ns = 8'000'000'000;  // asks again for removal, for putting right, after so long
};

// What happened since the last step. `now_ns` is the capture time of the frame in work.
struct GameInputs {
  std::int64_t now_ns = 0;
  std::optional<Occupancy> sight;  // the reading of this frame, if there is one
  std::vector<Feedback> feedback;  // of the virtual human
  std::vector<Control> controls;
  std::optional<std::string> engine_move;  // the answer to `think`, as in PDN with the whole path
  bool renderer_joined = false;            // a fresh renderer: it knows nothing and its human is at the entrance
};

struct GameOutputs {
  std::vector<GameEvent> events;
  std::vector<Command> commands;
  std::optional<BoardState> board_state;  // when it changed
  std::optional<Scene> scene;         // when virtual pieces changed otherwise than by a grasp, and for a fresh renderer
  std::optional<std::string> think;   // a FEN: start thinking about the virtual player's move here
  std::vector<std::string> rejected;  // controls that could not be carried out: a sentence each
};

class Game {
 public:
  // Fails with a sentence if rules or FEN are unusable.
  [[nodiscard]] static Result<Game> start(const GameOptions& options);

  // Goes on where `saved` (see `save`) was left, for instance after this process was killed.
  [[nodiscard]] static Result<Game> resume(const GameOptions& options, const std::string& saved);

  Game(Game&&) noexcept;
  Game& operator=(Game&&) noexcept;
  ~Game();

  GameOutputs step(const GameInputs& inputs);

  const BoardState& board_state() const;
  Scene scene() const;

  // JSON text with everything that `resume` needs.
  std::string save() const;

  // The game so far as PDN 3.0.
  std::string pdn() const;

 private:
  struct State;
  explicit Game(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace counterpart
