#include "protocol/transport/socket_set.hpp"

#include <algorithm>
#include <ctime>

#include <sys/eventfd.h>
#include <unistd.h>

namespace counterpart {

SocketSet::SocketSet() : epoll_(::epoll_create1(EPOLL_CLOEXEC)), bell_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u32 = kBell;
  static_cast<void>(::epoll_ctl(epoll_, EPOLL_CTL_ADD, bell_, &event));
}

SocketSet::~SocketSet() {
  ::close(bell_);
  ::close(epoll_);
}

void SocketSet::want(int socket, std::uint32_t id, bool read, bool write, std::uint32_t& wanted) const {
  // A socket that is registered for nothing still tells of its end, over and over: such a one is taken out.
  const std::uint32_t events = (read ? std::uint32_t{EPOLLIN} : 0U) | (write ? std::uint32_t{EPOLLOUT} : 0U);
  if (events == wanted) return;
  epoll_event event{};
  event.events = events;
  event.data.u32 = id;
  const int change = events == 0 ? EPOLL_CTL_DEL : wanted == 0 ? EPOLL_CTL_ADD : EPOLL_CTL_MOD;
  static_cast<void>(::epoll_ctl(epoll_, change, socket, &event));
  wanted = events;
}

std::span<const SocketSet::Ready> SocketSet::wait(std::int64_t timeout_ns) {
  const timespec limit{timeout_ns / 1'000'000'000, timeout_ns % 1'000'000'000};
  const int count = ::epoll_pwait2(epoll_, events_.data(), static_cast<int>(events_.size()), &limit, nullptr);
  std::size_t ready = 0;
  for (int i = 0; i < count; ++i) {
    const epoll_event& event = events_[static_cast<std::size_t>(i)];
    if (event.data.u32 == kBell) {
      eventfd_t ignored = 0;
      static_cast<void>(::eventfd_read(bell_, &ignored));
    } else {
      ready_[ready++] = {event.data.u32, (event.events & ~std::uint32_t{EPOLLOUT}) != 0,
                         (event.events & EPOLLOUT) != 0};
    }
  }
  return {ready_.data(), ready};
}

void SocketSet::ring() const {
  static_cast<void>(::eventfd_write(bell_, 1));
}

}  // namespace counterpart
