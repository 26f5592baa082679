#include "protocol/codec/crc32c.hpp"

#include "protocol/codec/crc_tables.hpp"

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

namespace counterpart {
namespace {

constexpr CrcTables kTables = make_crc_tables(0x82F63B78);  // 0x1EDC6F41, bits reversed

#if defined(__x86_64__)
__attribute__((target("sse4.2"))) std::uint32_t crc32c_by_hardware(ByteView bytes, std::uint32_t crc) {
  std::uint64_t state = ~crc;
  const std::uint8_t* at = bytes.data();
  std::size_t left = bytes.size();
  for (; left >= 8; at += 8, left -= 8) state = _mm_crc32_u64(state, load<std::uint64_t>(at));
  auto narrow = static_cast<std::uint32_t>(state);
  for (; left > 0; ++at, --left) narrow = _mm_crc32_u8(narrow, *at);
  return ~narrow;
}
#endif

}  // namespace

std::uint32_t crc32c_by_table(ByteView bytes, std::uint32_t crc) {
  return crc_by_table(kTables, bytes, crc);
}

std::uint32_t crc32c(ByteView bytes, std::uint32_t crc) {
#if defined(__x86_64__)
  static const bool hardware = __builtin_cpu_supports("sse4.2") != 0;
  if (hardware) return crc32c_by_hardware(bytes, crc);
#endif
  return crc32c_by_table(bytes, crc);
}

}  // namespace counterpart
