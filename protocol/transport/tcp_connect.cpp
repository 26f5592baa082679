#include "protocol/transport/tcp_connect.hpp"

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include <boost/asio.hpp>

namespace counterpart {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

struct Attempt {
  Attempt(asio::io_context& io, Connected its_end) : resolver(io), socket(io), limit(io), end(std::move(its_end)) {}

  void finish(const error_code& error) {
    if (std::exchange(done, true)) return;
    limit.cancel();
    end(error, std::move(socket));
  }

  tcp::resolver resolver;
  tcp::socket socket;
  asio::steady_timer limit;
  Connected end;
  bool done = false;
};

}  // namespace

Result<tcp::acceptor> open_acceptor(asio::io_context& io, const HostPort& address, bool has_token) {
  error_code error;
  const auto found = tcp::resolver(io).resolve(address.host, std::to_string(address.port), error);
  if (error || found.empty()) {
    return failure(ErrorCode::not_found, "the host \"" + address.host + "\" is not known: " + error.message());
  }
  const tcp::endpoint where = found.begin()->endpoint();
  if (!where.address().is_loopback() && !has_token) {
    return failure(ErrorCode::refused, to_text(address) +
                                           " can be reached from other hosts: give a token file (--token-file), or "
                                           "listen on 127.0.0.1");
  }
  tcp::acceptor acceptor(io);
  acceptor.open(where.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(where, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error == asio::error::address_in_use) {
    return failure(ErrorCode::unavailable, to_text(address) +
                                               " is in use: another program listens there; stop it or choose another "
                                               "port with --listen");
  }
  if (error) return failure(ErrorCode::io, "cannot listen on " + to_text(address) + ": " + error.message());
  return acceptor;
}

void connect_socket(asio::io_context& io, const HostPort& address, std::int64_t limit_ns, Connected connected) {
  const auto attempt = std::make_shared<Attempt>(io, std::move(connected));
  attempt->limit.expires_after(std::chrono::nanoseconds(limit_ns));
  attempt->limit.async_wait([attempt](const error_code& cancelled) {
    if (cancelled || attempt->done) return;
    error_code ignored;
    attempt->resolver.cancel();
    attempt->socket.close(ignored);
    attempt->finish(asio::error::timed_out);
  });
  attempt->resolver.async_resolve(
      address.host, std::to_string(address.port),
      [attempt](const error_code& error, const tcp::resolver::results_type& found) {
        if (error || attempt->done) return attempt->finish(error);
        asio::async_connect(attempt->socket, found,
                            [attempt](const error_code& failed, const tcp::endpoint&) { attempt->finish(failed); });
      });
}

}  // namespace counterpart
