// Scenarios: commands with chaining, timing, loops and expectations, one statement a line. docs/vhp-script.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/vhp/request.hpp"

namespace counterpart::vhp {

enum class StatementKind : std::uint8_t {
  request = 1,         // a command or control
  wait = 2,            // until commands have ended
  expect_command = 3,  // how a command ended
  expect_event = 4,    // of the game
  expect_phase = 5,    // of the game
  sleep = 6,
  repeat = 7,
  print = 8,
};

struct Statement {
  StatementKind kind = StatementKind::sleep;
  int line = 0;
  std::string text;                 // as written
  std::string label;                // of a request: its name from here on
  std::vector<std::string> labels;  // those to wait for; of a request: those it comes after
  Request request;
  FeedbackState state = FeedbackState::finished;
  EventKind event = EventKind::move;
  GamePhase phase = GamePhase::real_to_move;
  std::string code;     // of a failure or an event; empty: any
  std::string move;     // of an event; empty: any
  double seconds = 10;  // limit, or how long to sleep
  int times = 1;
  std::vector<Statement> body;  // of repeat
};

// Nothing is done before the whole text was understood; errors begin with NAME:LINE.
[[nodiscard]] Result<std::vector<Statement>> parse_script(const std::string& text, const std::string& name);

}  // namespace counterpart::vhp
