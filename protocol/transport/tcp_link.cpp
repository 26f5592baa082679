#include "protocol/transport/tcp_link.hpp"

#include <cerrno>
#include <utility>

#include <boost/asio/error.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include "protocol/transport/monotonic_clock.hpp"
#include "protocol/transport/network_error.hpp"

namespace counterpart {
namespace {

constexpr std::size_t kMostAtOnce = 32;   // messages in one write
constexpr std::size_t kSmallBody = 1024;  // is cheaper to copy than to name
constexpr std::size_t kMostBytesAtOnce = 256U << 10;
constexpr int kMostReadsInARow = 64;

}  // namespace

void TcpLink::close() {
  if (socket_ < 0) return;
  ::shutdown(socket_, SHUT_RDWR);
  ::close(std::exchange(socket_, -1));
}

// What TLS has taken from the socket nobody will be woken for, so it is read in any case.
bool TcpLink::reads_on(const Hub& hub, int rounds) const {
  if (broken_) return false;
  if (tls_ && tls_->has_pending()) return hub.listens(id_);
  return rounds < kMostReadsInARow && hub.wants_read(id_);
}

ssize_t TcpLink::read_some(std::span<std::uint8_t> room) {
  return tls_ ? tls_->read(room) : ::recv(socket_, room.data(), room.size(), MSG_DONTWAIT);
}

void TcpLink::read(Hub& hub, std::int64_t now_ns) {
  for (int rounds = 0; reads_on(hub, rounds); ++rounds) {
    const auto room = hub.parser(id_).room();
    const ssize_t count = read_some(room);
    if (count == 0) broken_ = boost::asio::error::eof;
    if (count < 0 && errno != EAGAIN && errno != EINTR) broken_ = last_system_error();
    if (count <= 0) return;
    hub.read(id_, static_cast<std::size_t>(count), rounds == 0 ? now_ns : monotonic_ns());
    if (!tls_ && static_cast<std::size_t>(count) < room.size()) return;  // the socket is empty
  }
}

void TcpLink::flush(Hub& hub, std::int64_t now_ns) {
  while (!blocked_ && !broken_) {
    if (buffers_.empty() && !gather(hub, now_ns)) return;
    const ssize_t count = write_some();
    if (count >= 0) {
      consume(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      if (tls_ && !tls_->waits_to_write()) return;  // reading brings it on
      blocked_ = true;
    } else if (errno != EINTR) {
      broken_ = last_system_error();
    }
  }
}

ssize_t TcpLink::write_some() {
  constexpr int kFlags = MSG_DONTWAIT | MSG_NOSIGNAL;
  if (tls_) return tls_->write({static_cast<const std::uint8_t*>(buffers_[0].iov_base), buffers_[0].iov_len});
  if (buffers_.size() == 1) return ::send(socket_, buffers_[0].iov_base, buffers_[0].iov_len, kFlags);
  msghdr message{};
  message.msg_iov = buffers_.data();
  message.msg_iovlen = buffers_.size();
  return ::sendmsg(socket_, &message, kFlags);
}

bool TcpLink::gather(Hub& hub, std::int64_t now_ns) {
  large_.clear();
  staging_.clear();
  std::size_t bytes = 0;
  for (std::size_t count = 0; count < kMostAtOnce && bytes < kMostBytesAtOnce; ++count) {
    auto message = hub.next_to_write(id_, now_ns);
    if (!message) break;
    staging_.reserve(kMostAtOnce * (kHeaderSize + kSmallBody));  // so that it stays where it is
    bytes += kHeaderSize + message->body->size();
    stage(message->header);
    if (message->body->size() <= kSmallBody) {
      stage(*message->body);
    } else {
      // sendmsg only reads, but its type does not say so.
      buffers_.push_back({const_cast<std::uint8_t*>(message->body->data()), message->body->size()});
      large_.push_back(std::move(*message));
    }
  }
  return !buffers_.empty();
}

// Into the buffer before, if that is the end of what is staged.
void TcpLink::stage(ByteView bytes) {
  std::uint8_t* const end = staging_.data() + staging_.size();
  staging_.insert(staging_.end(), bytes.begin(), bytes.end());
  const bool goes_on =
      !buffers_.empty() && static_cast<std::uint8_t*>(buffers_.back().iov_base) + buffers_.back().iov_len == end;
  if (goes_on) {
    buffers_.back().iov_len += bytes.size();
  } else {
    buffers_.push_back({end, bytes.size()});
  }
}

void TcpLink::consume(std::size_t count) {
  std::size_t whole = 0;
  while (whole < buffers_.size() && count >= buffers_[whole].iov_len) count -= buffers_[whole++].iov_len;
  buffers_.erase(buffers_.begin(), buffers_.begin() + static_cast<std::ptrdiff_t>(whole));
  if (count == 0) return;
  buffers_.front().iov_base = static_cast<char*>(buffers_.front().iov_base) + count;
  buffers_.front().iov_len -= count;
}

}  // namespace counterpart
