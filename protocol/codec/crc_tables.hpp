// Reflected 32-bit CRCs by tables, eight bytes at a time ("slicing by 8").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/codec/bytes.hpp"

namespace counterpart {

using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

// polynomial: bits reversed.
constexpr CrcTables make_crc_tables(std::uint32_t polynomial) {
  CrcTables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? polynomial : 0);
    tables[0][byte] = crc;
  }
  for (std::size_t slice = 1; slice < 8; ++slice) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[slice - 1][byte];
      tables[slice][byte] = (before >> 8) ^ tables[0][before & 0xFF];
    }
  }
  return tables;
}

// `crc`: of what came before, 0 at the start.
inline std::uint32_t crc_by_table(const CrcTables& tables, ByteView bytes, std::uint32_t crc) {
  std::uint32_t state = ~crc;
  const std::uint8_t* at = bytes.data();
  std::size_t left = bytes.size();
  for (; left >= 8; at += 8, left -= 8) {
    const std::uint64_t word = load<std::uint64_t>(at) ^ state;
    state = 0;
    for (unsigned byte = 0; byte < 8; ++byte) state ^= tables[7 - byte][(word >> (8 * byte)) & 0xFF];
  }
  for (; left > 0; ++at, --left) state = (state >> 8) ^ tables[0][(state ^ *at) & 0xFF];
  return ~state;
}

}  // namespace counterpart
