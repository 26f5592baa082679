// Messages ↔ the bytes of their bodies: docs/protocol.md, section 2.
#pragma once

#include "protocol/codec/bytes.hpp"
#include "protocol/framing/header.hpp"
#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// The version of each type's body that this program writes.
constexpr std::uint8_t kTypeVersion = 1;

// Fails on what a receiver would refuse: NaN, values out of range, more than the type's limit.
[[nodiscard]] Result<Bytes> encode(const Message& message);

// The same, into memory that is there already; what was in it is gone.
[[nodiscard]] Result<void> encode(const Message& message, Bytes& out);

bool is_known(std::uint16_t type);

// Bodies longer than this version's are read as far as they are known.
[[nodiscard]] Result<Message> decode(MessageType type, ByteView body);

// The same; a picture keeps the memory that it came in.
[[nodiscard]] Result<Message> decode(MessageType type, Bytes&& body);

// The frame that a message was made from; 0 if it was not made from one.
FrameId frame_of(const Message& message);

// True for the types whose body is JSON text.
bool is_json(MessageType type);

}  // namespace counterpart
