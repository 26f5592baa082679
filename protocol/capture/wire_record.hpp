// One message as it went over the wire, in a capture's /wire topic: docs/protocol.md, section 7.
#pragma once

#include "protocol/framing/header.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct WireRecord {
  bool incoming = false;  // as the recorder saw it
  bool video_lane = false;
  std::uint32_t peer = 0;
  Header header;
  ByteView body;  // into the record that was read
};

// Behind what `out` holds already.
void append_wire_record(Bytes& out, bool incoming, bool video_lane, std::uint32_t peer, const HeaderBytes& header,
                        ByteView body);

// Checks lengths and the message's own CRC.
[[nodiscard]] Result<WireRecord> read_wire_record(ByteView record);

}  // namespace counterpart
