#include "game_controller/links/line_output.hpp"

#include <cerrno>
#include <chrono>
#include <string_view>
#include <utility>

#include <poll.h>
#include <unistd.h>

namespace counterpart {
namespace {

// A pipe that says it takes anything takes this much without blocking (POSIX: PIPE_BUF is at least 512).
constexpr std::size_t taken_at_once = 512;

}  // namespace

void LineOutput::put(std::string line) {
  // The first line may have been written in part.
  if (lines_.size() >= most_lines_kept) lines_.erase(lines_.begin() + (written_ > 0 ? 1 : 0));
  lines_.push_back(std::move(line) + "\n");
  flush();
}

void LineOutput::flush() {
  while (!lines_.empty() && takes_more(0) && write_some()) {
  }
}

bool LineOutput::finish(double patience_s) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(patience_s);
  while (!lines_.empty()) {
    const double left_s = std::chrono::duration<double>(end - Clock::now()).count();
    if (!takes_more(left_s <= 0 ? 0 : static_cast<int>(1000 * left_s) + 1) || !write_some()) return false;
  }
  return true;
}

bool LineOutput::takes_more(int timeout_ms) const {
  pollfd p{descriptor_, POLLOUT, 0};
  return ::poll(&p, 1, timeout_ms) > 0;
}

// False when the reader is gone.
bool LineOutput::write_some() {
  const std::string_view rest = std::string_view(lines_.front()).substr(written_, taken_at_once);
  const auto n = ::write(descriptor_, rest.data(), rest.size());
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  written_ += static_cast<std::size_t>(n);
  if (written_ == lines_.front().size()) {
    lines_.pop_front();
    written_ = 0;
  }
  return true;
}

}  // namespace counterpart
