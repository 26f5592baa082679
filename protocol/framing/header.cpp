#include "protocol/framing/header.hpp"

#include <cstring>

#include "protocol/codec/crc32c.hpp"

namespace counterpart {
namespace {

constexpr std::array<std::uint8_t, 4> kHeaderMagic{'V', 'H', 'P', '1'};
constexpr std::size_t kCrcAt = 12;
constexpr std::size_t kAfterCrc = 16;

std::uint32_t checksum(std::span<const std::uint8_t, kHeaderSize> header, ByteView body) {
  const std::uint32_t front = crc32c(header.first(kCrcAt));
  return crc32c(body, crc32c(header.subspan(kAfterCrc), front));
}

}  // namespace

std::uint32_t max_length(std::uint16_t type) {
  switch (static_cast<MessageType>(type)) {
    case MessageType::video:
      return 16U << 20;
    case MessageType::mask:
    case MessageType::debug:
      return 1U << 20;
    default:
      return 64U << 10;
  }
}

HeaderBytes seal(Header header, ByteView body) {
  HeaderBytes out{};
  std::memcpy(out.data(), kHeaderMagic.data(), kHeaderMagic.size());
  store(out.data() + 4, header.type);
  store(out.data() + 6, header.type_version);
  store(out.data() + 7, header.flags);
  store(out.data() + 8, static_cast<std::uint32_t>(body.size()));
  store(out.data() + 16, header.session);
  store(out.data() + 24, header.seq);
  store(out.data() + 32, header.frame_id);
  store(out.data() + 40, header.time_ns);
  store(out.data() + kCrcAt, checksum(out, body));
  return out;
}

Result<Header> read_header(std::span<const std::uint8_t, kHeaderSize> bytes) {
  if (std::memcmp(bytes.data(), kHeaderMagic.data(), kHeaderMagic.size()) != 0) {
    return failure(ErrorCode::bad_format, "a message does not begin with VHP1: the peer does not speak this protocol");
  }
  Header header;
  header.type = load<std::uint16_t>(bytes.data() + 4);
  header.type_version = load<std::uint8_t>(bytes.data() + 6);
  header.flags = load<std::uint8_t>(bytes.data() + 7);
  header.length = load<std::uint32_t>(bytes.data() + 8);
  header.crc = load<std::uint32_t>(bytes.data() + kCrcAt);
  header.session = load<std::uint64_t>(bytes.data() + 16);
  header.seq = load<std::uint64_t>(bytes.data() + 24);
  header.frame_id = load<std::uint64_t>(bytes.data() + 32);
  header.time_ns = load<std::int64_t>(bytes.data() + 40);
  if (header.length > max_length(header.type)) {
    return failure(ErrorCode::limit_exceeded, "a message of type " + std::to_string(header.type) + " says it has " +
                                                  std::to_string(header.length) + " bytes, more than the " +
                                                  std::to_string(max_length(header.type)) + " permitted");
  }
  return header;
}

bool crc_matches(std::span<const std::uint8_t, kHeaderSize> header, ByteView body) {
  return load<std::uint32_t>(header.data() + kCrcAt) == checksum(header, body);
}

}  // namespace counterpart
