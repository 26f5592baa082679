// The 48 bytes before every message: docs/protocol.md, section 1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/codec/bytes.hpp"
#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

constexpr std::size_t kHeaderSize = 48;
constexpr std::uint8_t kFlagKept = 1;

struct Header {
  std::uint16_t type = 0;  // a MessageType, or one of a later version
  std::uint8_t type_version = 1;
  std::uint8_t flags = 0;
  std::uint32_t length = 0;  // bytes of the body
  std::uint32_t crc = 0;
  std::uint64_t session = 0;
  std::uint64_t seq = 0;
  std::uint64_t frame_id = 0;
  std::int64_t time_ns = 0;  // sender's monotonic clock

  friend bool operator==(const Header&, const Header&) = default;
};

using HeaderBytes = std::array<std::uint8_t, kHeaderSize>;

// The largest body a message of this type may have, bytes. Types that are not known have the smallest limit.
std::uint32_t max_length(std::uint16_t type);

// Fills in length and crc for this body.
HeaderBytes seal(Header header, ByteView body);

// Looks at magic and length only; the CRC needs the body (crc_matches).
[[nodiscard]] Result<Header> read_header(std::span<const std::uint8_t, kHeaderSize> bytes);

bool crc_matches(std::span<const std::uint8_t, kHeaderSize> header, ByteView body);

}  // namespace counterpart
