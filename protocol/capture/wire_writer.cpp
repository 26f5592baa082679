#include "protocol/capture/wire_writer.hpp"

#include "protocol/codec/codec.hpp"
#include "protocol/codec/names.hpp"

namespace counterpart {

bool add_wire_record(McapWriter& writer, ByteView record, std::int64_t log_ns) {
  const auto wire = read_wire_record(record);
  if (!wire) return false;
  const auto log = static_cast<std::uint64_t>(log_ns);
  const auto publish = static_cast<std::uint64_t>(wire->header.time_ns);
  writer.add(writer.channel("/wire", "counterpart-wire"), log, publish, record);
  const auto type = static_cast<MessageType>(wire->header.type);
  if (is_known(wire->header.type) && type != MessageType::video) {  // pictures are stored once
    const std::string topic = (wire->incoming ? "/in/" : "/out/") + std::string(name_of(type));
    writer.add(writer.channel(topic, is_json(type) ? "json" : "counterpart"), log, publish, wire->body);
  }
  return true;
}

}  // namespace counterpart
