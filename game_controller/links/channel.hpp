// A stream of messages to another program, over TCP or to a child process, each message ended by one character.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

class Channel {
 public:
  Channel() = default;
  explicit Channel(int descriptor) : descriptor_(descriptor) {}
  ~Channel();
  Channel(Channel&& other) noexcept;
  Channel& operator=(Channel&& other) noexcept;

  bool is_open() const { return descriptor_ >= 0; }

  // Fails with `closed` if the other side is gone and `timeout` if it takes nothing for five seconds.
  [[nodiscard]] Result<void> send(std::string_view bytes);

  // The next message, without its end. Fails with `timeout`, `closed`, `limit_exceeded` (longer than `longest`) or
  // `refused` (give_up, asked twenty times a second, has said so).
  [[nodiscard]] Result<std::string> receive(char end, std::size_t longest, double timeout_s,
                                            const std::function<bool()>& give_up = {});

 private:
  int descriptor_ = -1;
  std::string received_;
};

// address: "HOST:PORT" or "PORT" (on this machine).
[[nodiscard]] Result<Channel> connect_to(const std::string& address, double timeout_s);

// Waits for programs that want to talk to us.
class Listener {
 public:
  // "PORT" listens on this machine only, "HOST:PORT" at that address.
  [[nodiscard]] static Result<Listener> open(const std::string& address);
  ~Listener();
  Listener(Listener&& other) noexcept;
  Listener& operator=(Listener&&) = delete;

  int port() const { return port_; }

  [[nodiscard]] Result<Channel> accept(const std::function<bool()>& give_up = {});

 private:
  Listener(int descriptor, int port) : descriptor_(descriptor), port_(port) {}
  int descriptor_ = -1;
  int port_ = 0;
};

// Runs a command line by the shell, in a process group of its own; the channel is its standard input and output.
class Child {
 public:
  [[nodiscard]] static Result<Child> start(const std::string& command);
  ~Child();  // ends the whole group
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;

  Channel& channel() { return channel_; }

 private:
  Child(int pid, Channel channel) : pid_(pid), channel_(std::move(channel)) {}
  void end();
  int pid_ = -1;
  Channel channel_;
};

}  // namespace counterpart
