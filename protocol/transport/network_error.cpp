#include "protocol/transport/network_error.hpp"

#include <cerrno>

#include <boost/asio/error.hpp>

namespace counterpart {

namespace asio = boost::asio;

boost::system::error_code last_system_error() {
  return {errno, boost::system::system_category()};
}

Error network_error(const boost::system::error_code& error, const std::string& address) {
  if (error == asio::error::connection_refused) {
    return {ErrorCode::unavailable, "nothing listens at " + address +
                                        " (connection refused): start the other program first, or check the port"};
  }
  if (error == asio::error::eof || error == asio::error::connection_reset || error == asio::error::broken_pipe) {
    return {ErrorCode::closed, "the peer closed the connection"};
  }
  return {ErrorCode::io, address + ": " + error.message()};
}

}  // namespace counterpart
