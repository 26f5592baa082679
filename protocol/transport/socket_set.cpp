#include "protocol/transport/socket_set.hpp"

#include <algorithm>
#include <ctime>

#include <sys/eventfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

namespace counterpart {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;

}  // namespace

SocketSet::SocketSet()
    : epoll_(::epoll_create1(EPOLL_CLOEXEC)),
      bell_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      alarm_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
  watch(bell_, kBell, EPOLLIN);
  watch(alarm_, kAlarm, EPOLLIN | EPOLLET);  // tells once of each time that it goes off, and need not be read
}

SocketSet::~SocketSet() {
  ::close(alarm_);
  ::close(bell_);
  ::close(epoll_);
}

void SocketSet::watch(int descriptor, std::uint32_t id, std::uint32_t events) const {
  epoll_event event{};
  event.events = events;
  event.data.u32 = id;
  static_cast<void>(::epoll_ctl(epoll_, EPOLL_CTL_ADD, descriptor, &event));
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

void SocketSet::set_alarm(std::int64_t when_ns) {
  itimerspec when{};
  when.it_value = {when_ns / kNsPerSecond, when_ns % kNsPerSecond};
  static_cast<void>(::timerfd_settime(alarm_, TFD_TIMER_ABSTIME, &when, nullptr));
  alarm_ns_ = when_ns;
}

// A time limit for each wait would set one of the system's timers every time, which costs more than the wait. The alarm
// stays set: a wait that an earlier one's alarm ends costs one more look, and that seldom.
std::span<const SocketSet::Ready> SocketSet::wait(std::int64_t now_ns, std::int64_t deadline_ns) {
  if (alarm_ns_ <= now_ns || alarm_ns_ > deadline_ns) set_alarm(deadline_ns);
  const int count = ::epoll_wait(epoll_, events_.data(), static_cast<int>(events_.size()), -1);
  std::size_t ready = 0;
  for (int i = 0; i < count; ++i) {
    const epoll_event& event = events_[static_cast<std::size_t>(i)];
    if (event.data.u32 == kBell) {
      eventfd_t ignored = 0;
      static_cast<void>(::eventfd_read(bell_, &ignored));
    } else if (event.data.u32 != kAlarm) {
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
