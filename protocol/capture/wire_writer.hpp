// Wire records into a capture: into /wire, and by type for people and other tools.
#pragma once

#include "protocol/capture/mcap_writer.hpp"
#include "protocol/capture/wire_record.hpp"

namespace counterpart {

// A record that is damaged is not written; false.
bool add_wire_record(McapWriter& writer, ByteView record, std::int64_t log_ns);

}  // namespace counterpart
