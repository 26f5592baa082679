// A connection that a test speaks for itself, badly if it likes.
#pragma once

#include <optional>
#include <string>

#include <boost/asio.hpp>

#include "protocol/framing/frame_parser.hpp"
#include "protocol/vocabulary/message.hpp"

namespace counterpart {

class Stranger {
 public:
  explicit Stranger(const std::string& address);

  // False: the other side has closed.
  bool say(const Message& message, std::uint64_t seq = 0);
  bool raw(ByteView bytes);

  // Every message that comes until the other side closes, or until one of the wanted type came.
  std::optional<Message> hear(std::optional<MessageType> wanted = std::nullopt);

 private:
  boost::asio::io_context io_;
  boost::asio::ip::tcp::socket socket_;
  FrameParser parser_;
};

// The bytes of a message as they go over the wire.
Bytes on_the_wire(const Message& message, std::uint64_t seq = 0);

}  // namespace counterpart
