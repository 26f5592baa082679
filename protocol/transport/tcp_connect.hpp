// Opening sockets: one to listen on, one to a peer.
#pragma once

#include <cstdint>
#include <functional>

#include <boost/asio/ip/tcp.hpp>

#include "protocol/transport/address.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// Port 0 takes a free one. Other addresses than loopback are only for those who have a token.
[[nodiscard]] Result<boost::asio::ip::tcp::acceptor> open_acceptor(boost::asio::io_context& io, const HostPort& address,
                                                                   bool has_token);

using Connected = std::function<void(const boost::system::error_code&, boost::asio::ip::tcp::socket)>;

// Looks the host up and connects, within limit_ns in all; says once, from io, how it went.
void connect_socket(boost::asio::io_context& io, const HostPort& address, std::int64_t limit_ns, Connected connected);

}  // namespace counterpart
