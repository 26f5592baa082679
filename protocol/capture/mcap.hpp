// The parts of the MCAP file format (version 0, https://mcap.dev/spec) that captures use: uncompressed chunks.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "protocol/codec/bytes.hpp"

namespace counterpart::mcap {

constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  metadata = 0x0C,
  metadata_index = 0x0D,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

constexpr std::size_t kRecordHead = 9;  // opcode u8, length u64

// The CRC-32 of zlib and Ethernet, which MCAP asks for (not the CRC32C of the wire).
std::uint32_t crc32(ByteView bytes, std::uint32_t crc = 0);

void append_text(Bytes& out, const std::string& text);
void append_map(Bytes& out, const std::map<std::string, std::string>& map);
void append_record(Bytes& out, Op op, ByteView content);

}  // namespace counterpart::mcap
