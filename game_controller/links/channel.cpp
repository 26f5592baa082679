#include "game_controller/links/channel.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace counterpart {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int patience_with_writing_ms = 5'000;
constexpr double look_again_s = 0.05;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool ready(int descriptor, short events, int timeout_ms) {
  pollfd p{descriptor, events, 0};
  return ::poll(&p, 1, timeout_ms) > 0;
}

tl::unexpected<Error> system_failure(const std::string& what) {
  return failure(ErrorCode::io, what + ": " + std::strerror(errno) + ".");
}

struct Address {
  std::string host;
  std::string port;
};

Address address_of(const std::string& text) {
  const auto colon = text.rfind(':');
  if (colon == std::string::npos) return {"127.0.0.1", text};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

// Calls `use` with a fresh socket for each address of the host until one works; returns that descriptor.
template <class Use>
Result<int> socket_for(const std::string& text, int flags, const Use& use) {
  const Address address = address_of(text);
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags;
  addrinfo* found = nullptr;
  const int code = ::getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found);
  if (code != 0) {
    return failure(ErrorCode::invalid_argument,
                   "\"" + text + "\" is not HOST:PORT: " + std::string(::gai_strerror(code)) + ".");
  }
  int descriptor = -1;
  for (addrinfo* a = found; a != nullptr && descriptor < 0; a = a->ai_next) {
    descriptor = ::socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
    if (descriptor >= 0 && !use(descriptor, *a)) {
      const int why = errno;
      ::close(descriptor);
      errno = why;
      descriptor = -1;
    }
  }
  ::freeaddrinfo(found);
  if (descriptor < 0) return system_failure("No connection at " + text);
  return descriptor;
}

bool connect_in_time(int descriptor, const addrinfo& address, double timeout_s) {
  ::fcntl(descriptor, F_SETFL, O_NONBLOCK);
  if (::connect(descriptor, address.ai_addr, address.ai_addrlen) == 0) return true;
  if (errno != EINPROGRESS) return false;
  if (!ready(descriptor, POLLOUT, static_cast<int>(timeout_s * 1000))) {
    errno = ETIMEDOUT;
    return false;
  }
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size);
  errno = error;
  return error == 0;
}

}  // namespace

Channel::~Channel() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Channel::Channel(Channel&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), received_(std::move(other.received_)) {}

Channel& Channel::operator=(Channel&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(received_, other.received_);
  return *this;
}

Result<void> Channel::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (!ready(descriptor_, POLLOUT, patience_with_writing_ms)) {
        return failure(ErrorCode::timeout, "The other program takes no more messages.");
      }
    } else if (errno != EINTR) {
      return failure(ErrorCode::closed, "The other program is gone.");
    }
  }
  return {};
}

Result<std::string> Channel::receive(char end, std::size_t longest, double timeout_s,
                                     const std::function<bool()>& give_up) {
  const auto start = Clock::now();
  while (true) {
    const auto at = received_.find(end);
    if (at != std::string::npos && at <= longest) {
      std::string message = received_.substr(0, at);
      received_.erase(0, at + 1);
      return message;
    }
    if (received_.size() > longest) {
      return failure(ErrorCode::limit_exceeded, "A message is longer than " + std::to_string(longest) + " characters.");
    }
    const double left = timeout_s - seconds_since(start);
    if (left <= 0) return failure(ErrorCode::timeout, "No answer came in time.");
    if (give_up && give_up()) return failure(ErrorCode::refused, "It is no longer waited for.");
    if (!ready(descriptor_, POLLIN, static_cast<int>(1000 * std::min(left, look_again_s)) + 1)) continue;
    std::array<char, 4096> block;
    const auto n = ::recv(descriptor_, block.data(), block.size(), 0);
    if (n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR)) {
      return failure(ErrorCode::closed, "The other program has closed the connection.");
    }
    if (n > 0) received_.append(block.data(), static_cast<std::size_t>(n));
  }
}

Result<Channel> connect_to(const std::string& address, double timeout_s) {
  const auto connected = socket_for(
      address, 0, [&](int descriptor, const addrinfo& a) { return connect_in_time(descriptor, a, timeout_s); });
  if (!connected) return tl::make_unexpected(connected.error());
  return Channel(*connected);
}

Result<Listener> Listener::open(const std::string& address) {
  const auto bound = socket_for(address, AI_PASSIVE, [](int descriptor, const addrinfo& a) {
    const int yes = 1;
    ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    return ::bind(descriptor, a.ai_addr, a.ai_addrlen) == 0 && ::listen(descriptor, 4) == 0;
  });
  if (!bound) return tl::make_unexpected(bound.error());
  sockaddr_storage name{};
  socklen_t size = sizeof name;
  ::getsockname(*bound, reinterpret_cast<sockaddr*>(&name), &size);
  char port[16] = "0";
  ::getnameinfo(reinterpret_cast<const sockaddr*>(&name), size, nullptr, 0, port, sizeof port, NI_NUMERICSERV);
  return Listener(*bound, std::stoi(port));
}

Listener::~Listener() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Listener::Listener(Listener&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)), port_(other.port_) {}

Result<Channel> Listener::accept(const std::function<bool()>& give_up) {
  while (!give_up || !give_up()) {
    if (!ready(descriptor_, POLLIN, static_cast<int>(1000 * look_again_s))) continue;
    const int descriptor = ::accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (descriptor >= 0) return Channel(descriptor);
  }
  return failure(ErrorCode::refused, "It is no longer listened.");
}

Result<Child> Child::start(const std::string& command) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    return system_failure("No channel to \"" + command + "\"");
  }
  const int pid = ::fork();
  if (pid == 0) {
    ::setpgid(0, 0);
    ::dup2(ends[1], STDIN_FILENO);
    ::dup2(ends[1], STDOUT_FILENO);
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    ::_exit(127);
  }
  ::close(ends[1]);
  Channel channel(ends[0]);
  if (pid < 0) return system_failure("\"" + command + "\" could not be started");
  ::setpgid(pid, pid);
  return Child(pid, std::move(channel));
}

Child::Child(Child&& other) noexcept : pid_(std::exchange(other.pid_, -1)), channel_(std::move(other.channel_)) {}

Child& Child::operator=(Child&& other) noexcept {
  std::swap(pid_, other.pid_);
  channel_ = std::move(other.channel_);
  return *this;
}

Child::~Child() {
  end();
}

// End of input means quit; what does not heed it within half a second is killed.
void Child::end() {
  if (pid_ <= 0) return;
  { const Channel closing = std::move(channel_); }
  ::kill(-pid_, SIGTERM);
  for (int i = 0; i < 50; ++i) {
    if (::waitpid(pid_, nullptr, WNOHANG) != 0) {
      ::kill(-pid_, SIGKILL);
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ::kill(-pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

}  // namespace counterpart
