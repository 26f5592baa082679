// A TCP relay between a client and a server, whose connections a test can cut or silence.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace counterpart {

class Relay {
 public:
  // Listens on a free port of 127.0.0.1 and passes everything on to this port.
  explicit Relay(std::uint16_t to_port);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  std::string address() const;
  void cut();                 // closes all connections; new ones are passed on
  void silence(bool silent);  // bytes are swallowed, connections stay open

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace counterpart
