// The sockets that one thread waits for, and a bell by which another thread ends the wait. They stay registered with
// the system from wait to wait, which makes a wait cheap.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
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

  // What is ready; empty: it is past the deadline, or the bell rang, or an earlier wait's deadline has come.
  std::span<const Ready> wait(std::int64_t now_ns, std::int64_t deadline_ns);

  // From any thread.
  void ring() const;

 private:
  static constexpr std::uint32_t kBell = 0;  // no connection has this id
  static constexpr std::uint32_t kAlarm = std::numeric_limits<std::uint32_t>::max();  // nor this one

  void watch(int descriptor, std::uint32_t id, std::uint32_t events) const;
  void set_alarm(std::int64_t when_ns);

  int epoll_;
  int bell_;
  int alarm_;
  std::int64_t alarm_ns_ = 0;  // when it goes off
  std::array<epoll_event, 16> events_{};
  std::array<Ready, 16> ready_{};
};

}  // namespace counterpart
