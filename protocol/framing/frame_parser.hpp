// Bytes as they come from a stream → whole messages. Knows no sockets and no clock.
#pragma once

#include <cstddef>
#include <optional>

#include "protocol/framing/header.hpp"

namespace counterpart {

struct RawMessage {
  Header header;
  HeaderBytes header_bytes{};
  Bytes body;
};

// The stream reader: give it room to read into, tell it how much came, take the messages out.
// After the first failure it stays failed: there is no safe way to find the next message.
class FrameParser {
 public:
  // Where the next bytes of the stream go; never empty. Bodies are read straight into their own memory, which grows as
  // they come: who only says that a message is large costs nothing.
  std::span<std::uint8_t> room();

  // `count` bytes of room() were filled.
  void filled(std::size_t count);

  // The next whole message; empty: more bytes are needed.
  [[nodiscard]] Result<std::optional<RawMessage>> next();

  // Takes back the memory of a body that is done with, for the next one.
  void reuse(Bytes&& body);

  // Copies bytes in and hands out nothing: for tests, files and memory links. next() must be called until empty first
  // and then again for every part that did not fit; returns how many bytes were taken.
  std::size_t feed(ByteView bytes);

  // True while a message has begun and is not complete.
  bool inside_message() const;

 private:
  void grow_body(std::size_t size);

  Bytes buffer_ = Bytes(kBufferSize);
  std::size_t begin_ = 0, end_ = 0;  // of the unread bytes in buffer_
  std::optional<RawMessage> open_;   // header read, body on its way
  std::size_t body_have_ = 0;        // of header.length
  Bytes spare_;
  std::optional<Error> failed_;

  static constexpr std::size_t kBufferSize = 64U << 10;
  static constexpr std::size_t kStep = 256U << 10;  // that a body grows by
};

}  // namespace counterpart
