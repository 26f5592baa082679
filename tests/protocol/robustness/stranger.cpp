#include "tests/protocol/robustness/stranger.hpp"

#include <algorithm>

#include "protocol/codec/codec.hpp"
#include "protocol/transport/address.hpp"

namespace counterpart {

namespace asio = boost::asio;

Bytes on_the_wire(const Message& message, std::uint64_t seq) {
  const Bytes body = *encode(message);
  Header header;
  header.type = static_cast<std::uint16_t>(type_of(message));
  header.seq = seq;
  header.flags = seq != 0 ? kFlagKept : 0;
  const HeaderBytes sealed = seal(header, body);
  Bytes all(sealed.size() + body.size());
  std::copy(body.begin(), body.end(), std::copy(sealed.begin(), sealed.end(), all.begin()));
  return all;
}

Stranger::Stranger(const std::string& address) : socket_(io_) {
  socket_.connect({asio::ip::address_v4::loopback(), parse_address(address)->port});
  socket_.set_option(asio::ip::tcp::no_delay(true));
}

bool Stranger::say(const Message& message, std::uint64_t seq) {
  return raw(on_the_wire(message, seq));
}

bool Stranger::raw(ByteView bytes) {
  boost::system::error_code error;
  asio::write(socket_, asio::buffer(bytes.data(), bytes.size()), error);
  return !error;
}

std::optional<Message> Stranger::hear(std::optional<MessageType> wanted) {
  std::optional<Message> last;
  for (;;) {
    for (auto raw = parser_.next(); raw && *raw; raw = parser_.next()) {
      const auto type = static_cast<MessageType>((*raw)->header.type);
      auto message = decode(type, (*raw)->body);
      if (!message) return std::nullopt;
      last = std::move(*message);
      if (wanted == type) return last;
    }
    boost::system::error_code error;
    const auto room = parser_.room();
    const std::size_t count = socket_.read_some(asio::buffer(room.data(), room.size()), error);
    if (error) return wanted ? std::nullopt : last;
    parser_.filled(count);
  }
}

}  // namespace counterpart
