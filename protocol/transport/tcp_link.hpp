// One connected socket: what is being written to it, and reading into its parser. Knows no threads: whoever calls holds
// the endpoint's lock.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <boost/system/error_code.hpp>
#include <sys/types.h>
#include <sys/uio.h>

#include "protocol/session/hub.hpp"
#include "protocol/transport/tls.hpp"

namespace counterpart {

class TcpLink {
 public:
  // Owns `connected`, a descriptor. tls: what its bytes go through; null: nothing.
  TcpLink(int connected, ConnectionId id, std::unique_ptr<TlsStream> tls)
      : socket_(connected), id_(id), tls_(std::move(tls)) {}
  ~TcpLink() { close(); }
  TcpLink(const TcpLink&) = delete;
  TcpLink& operator=(const TcpLink&) = delete;

  int socket() const { return socket_; }
  ConnectionId id() const { return id_; }

  bool blocked() const { return blocked_; }  // the socket takes no more for now
  void unblock() { blocked_ = false; }
  bool writing() const { return !buffers_.empty(); }
  const boost::system::error_code& broken() const { return broken_; }
  std::optional<Error> tls_error() const { return tls_ ? tls_->error() : std::nullopt; }

  // Gives the hub what has come, until nothing more is there or it wants no more.
  void read(Hub& hub, std::int64_t now_ns);

  // Writes what the hub has for it, until there is nothing more or the socket takes no more.
  void flush(Hub& hub, std::int64_t now_ns);

  void close();

  std::uint32_t waited_for = 0;  // its registration in the endpoint's SocketSet

 private:
  bool reads_on(const Hub& hub, int rounds) const;
  ssize_t read_some(std::span<std::uint8_t> room);
  bool gather(Hub& hub, std::int64_t now_ns);
  void stage(ByteView bytes);
  ssize_t write_some();
  void consume(std::size_t count);

  int socket_;
  ConnectionId id_;
  std::unique_ptr<TlsStream> tls_;
  bool blocked_ = false;
  boost::system::error_code broken_;
  // The write in progress: headers and small bodies behind each other in `staging_`, large bodies where they are.
  std::vector<WireMessage> large_;
  Bytes staging_;
  std::vector<iovec> buffers_;  // what is left to write
};

}  // namespace counterpart
