// What finds a move for a position: this program's engine, another program, or a distant player.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "game_controller/engine/opponent.hpp"
#include "game_controller/rules/rules.hpp"

namespace counterpart {

class Mind {
 public:
  virtual ~Mind() = default;
  // Blocks until there is an answer or `give_up` says so.
  virtual Result<OpponentMove> answer(const std::string& fen, const std::function<bool()>& give_up) = 0;
  // Uses the other side's time to think on after an answer, until `give_up` says so or there is enough.
  virtual void ponder(const std::function<bool()>& give_up) { static_cast<void>(give_up); }
};

// As `options.mind` says; see OpponentOptions.
[[nodiscard]] Result<std::unique_ptr<Mind>> make_mind(const Rules& rules, const OpponentOptions& options);

}  // namespace counterpart
