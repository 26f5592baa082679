// The show in place of a game: waits for a good look at the board, then plays `plan_show` once for each fresh renderer.
#pragma once

#include <optional>

#include "game_controller/game/game.hpp"
#include "game_controller/game/show.hpp"
#include "tracker_server/pipeline/observe.hpp"

namespace counterpart {

class ShowActivity {
 public:
  GameOutputs step(const Observation& observation, const GameOptions& options, bool renderer_joined);

 private:
  std::optional<Show> show_;
  bool wanted_ = false;
};

}  // namespace counterpart
