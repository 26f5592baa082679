// The TCP port of the Virtual Human Director (paper, section 4): commands from anybody who may connect, beside the
// tracker's.
#pragma once

#include <memory>
#include <vector>

#include "protocol/session/command_relay.hpp"
#include "protocol/transport/endpoint.hpp"

namespace counterpart {

class DirectorPort {
 public:
  // Null link: nobody can connect.
  explicit DirectorPort(std::unique_ptr<Endpoint> link);

  std::vector<Command> take_commands();
  // True if it was an answer to one of this port's commands; then it has been sent.
  bool answer(const Feedback& feedback);

 private:
  std::unique_ptr<Endpoint> link_;
  CommandRelay relay_;
};

}  // namespace counterpart
