#include "protocol/capture/wire_record.hpp"

namespace counterpart {
namespace {

constexpr std::size_t kHead = 8;

}  // namespace

void append_wire_record(Bytes& out, bool incoming, bool video_lane, std::uint32_t peer, const HeaderBytes& header,
                        ByteView body) {
  append(out, static_cast<std::uint8_t>(incoming ? 1 : 2));
  append(out, static_cast<std::uint8_t>(video_lane ? 2 : 1));
  append(out, std::uint16_t{0});
  append(out, peer);
  out.insert(out.end(), header.begin(), header.end());
  out.insert(out.end(), body.begin(), body.end());
}

Result<WireRecord> read_wire_record(ByteView record) {
  if (record.size() < kHead + kHeaderSize) return failure(ErrorCode::bad_format, "a wire record is too short");
  const auto header_bytes = record.subspan<kHead, kHeaderSize>();
  auto header = read_header(header_bytes);
  if (!header) return tl::make_unexpected(header.error());
  WireRecord wire;
  wire.incoming = record[0] == 1;
  wire.video_lane = record[1] == 2;
  wire.peer = load<std::uint32_t>(record.data() + 4);
  wire.header = *header;
  wire.body = record.subspan(kHead + kHeaderSize);
  if (wire.body.size() != header->length || !crc_matches(header_bytes, wire.body)) {
    return failure(ErrorCode::bad_format, "the checksum of a recorded message does not match");
  }
  return wire;
}

}  // namespace counterpart
