// A command or control as written on a command line: "grasp light_31 27 --hand left", "control level 3". Shared by
// `vhp send` and by scripts.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"

namespace CLI {
class App;
}

namespace counterpart::vhp {

struct Request {
  Command command;
  Control control;
  bool is_control = false;
  BoardGeometry board;  // for places given by a square's number

  // As written, before it is read into `command`.
  std::vector<std::string> path, control_values;
  std::string hand = "any", part = "whole", target, what, kind, raw;
  Grasp grasp;
  Keyframe keyframe;
  Navigate navigate;
  Gaze gaze;
  Say say;
  Express express;
  Stop stop;
};

// Adds the verbs and the options of commands; parsing fills the request, or throws a CLI::ValidationError.
void add_request(CLI::App& app, const std::shared_ptr<Request>& request);

// One line as a script has it.
[[nodiscard]] Result<Request> read_request(const std::string& line, const BoardGeometry& board);

// A new id for a command or control, unlike those of earlier runs.
std::uint64_t new_id();

// The command or control, if every value of it can be meant.
[[nodiscard]] Result<Message> message_of(const Request& request);

}  // namespace counterpart::vhp
