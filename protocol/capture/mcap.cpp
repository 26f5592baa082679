#include "protocol/capture/mcap.hpp"

#include "protocol/codec/crc_tables.hpp"

namespace counterpart::mcap {
namespace {

constexpr CrcTables kZipTables = make_crc_tables(0xEDB88320);

}  // namespace

std::uint32_t crc32(ByteView bytes, std::uint32_t crc) {
  return crc_by_table(kZipTables, bytes, crc);
}

void append_text(Bytes& out, const std::string& text) {
  append(out, static_cast<std::uint32_t>(text.size()));
  out.insert(out.end(), text.begin(), text.end());
}

void append_map(Bytes& out, const std::map<std::string, std::string>& map) {
  Bytes entries;
  for (const auto& [key, value] : map) {
    append_text(entries, key);
    append_text(entries, value);
  }
  append(out, static_cast<std::uint32_t>(entries.size()));
  out.insert(out.end(), entries.begin(), entries.end());
}

void append_record(Bytes& out, Op op, ByteView content) {
  append(out, static_cast<std::uint8_t>(op));
  append(out, static_cast<std::uint64_t>(content.size()));
  out.insert(out.end(), content.begin(), content.end());
}

}  // namespace counterpart::mcap
