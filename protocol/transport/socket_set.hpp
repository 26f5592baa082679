// The sockets that one thread waits for, and a bell by which another thread ends the wait. They stay registered with
// the system from wait to wait, which makes a wait cheap.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <sys/epoll.h>

namespace counterpart {

class SocketSet {
 public:
  struct Ready {
    std::uint32_t id = 0;
    bool read = false;  // or something is wrong with it, which reading tells
    bool write = false;
  };

  SocketSet();
  ~SocketSet();
  SocketSet(const SocketSet&) = delete;
  SocketSet& operator=(const SocketSet&) = delete;

  // What to wait for on this socket from now on. `wanted` is its registration, 0 at the start; closing a socket ends
  // it.
  void want(int socket, std::uint32_t id, bool read, bool write, std::uint32_t& wanted) const;

  // What is ready; empty: the time is over, or the bell rang.
  std::span<const Ready> wait(std::int64_t timeout_ns);

  // From any thread.
  void ring() const;

 private:
  static constexpr std::uint32_t kBell = 0;  // no connection has this id

  int epoll_;
  int bell_;
  std::array<epoll_event, 16> events_{};
  std::array<Ready, 16> ready_{};
};

}  // namespace counterpart
