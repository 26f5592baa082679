// Another program's engine that speaks Hub 2 (Scan, or any other), as the finder of moves.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "game_controller/links/channel.hpp"
#include "game_controller/links/hub_line.hpp"
#include "game_controller/rules/move.hpp"
#include "game_controller/rules/position.hpp"

namespace counterpart {

struct HubAnswer {
  Move move{};
  double score = 0;        // in men, for the side to move; 0 if the engine tells none
  std::vector<Move> line;  // the move first; at least one
};

class HubClient {
 public:
  // Starts the command line and waits until the engine is ready, at most `patience_s`.
  [[nodiscard]] static Result<HubClient> start(const std::string& command, double patience_s = 20);

  const std::string& name() const { return name_; }

  // International rules. Fails if the engine dies, keeps silent beyond twice the time and two seconds, or names an
  // illegal move. When `give_up` says so the engine is told to stop and `refused` comes back.
  [[nodiscard]] Result<HubAnswer> ask(const Position& position, double move_time_s,
                                      const std::function<bool()>& give_up = {});

 private:
  explicit HubClient(Child child) : child_(std::move(child)) {}
  Result<HubLine> next_line(double timeout_s, const std::function<bool()>& give_up = {});
  Result<void> say(const std::string& line);
  Result<void> wait_for(const std::string& command, double patience_s);
  void stop();

  Child child_;
  std::string name_;
};

}  // namespace counterpart
