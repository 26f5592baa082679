#include "protocol/codec/crc32c.hpp"

#include "protocol/codec/crc_tables.hpp"

#if defined(__x86_64__)
#include <nmmintrin.h>
#endif

namespace counterpart {
namespace {

constexpr CrcTables kCastagnoli = make_crc_tables(0x82F63B78);  // 0x1EDC6F41, bits reversed

#if defined(__x86_64__)
// The instruction takes three cycles, but three can be under way at a time: large bodies are read in three stripes,
// whose checksums are put together again.
constexpr std::size_t kStripe = 1024;

// What a checksum becomes when a stripe of zeros follows. That is linear, so it can be looked up byte by byte.
class StripeShift {
 public:
  StripeShift() {
    for (unsigned bit = 0; bit < 32; ++bit) {
      std::uint32_t state = 1U << bit;
      for (std::size_t i = 0; i < kStripe; ++i) state = (state >> 8) ^ kCastagnoli[0][state & 0xFF];
      auto& table = tables_[bit / 8];
      for (unsigned byte = 0; byte < 256; ++byte) table[byte] ^= (byte >> (bit % 8) & 1) != 0 ? state : 0;
    }
  }

  std::uint64_t operator()(std::uint64_t state) const {
    return tables_[0][state & 0xFF] ^ tables_[1][state >> 8 & 0xFF] ^ tables_[2][state >> 16 & 0xFF] ^
           tables_[3][state >> 24 & 0xFF];
  }

 private:
  std::array<std::array<std::uint32_t, 256>, 4> tables_{};
};

__attribute__((target("sse4.2"))) std::uint32_t crc32c_by_hardware(ByteView bytes, std::uint32_t crc) {
  std::uint64_t state = ~crc;
  const std::uint8_t* at = bytes.data();
  std::size_t left = bytes.size();
  for (; left >= 3 * kStripe; at += 3 * kStripe, left -= 3 * kStripe) {
    static const StripeShift shift;
    std::uint64_t second = 0, third = 0;
    for (std::size_t i = 0; i < kStripe; i += 8) {
      state = _mm_crc32_u64(state, load<std::uint64_t>(at + i));
      second = _mm_crc32_u64(second, load<std::uint64_t>(at + kStripe + i));
      third = _mm_crc32_u64(third, load<std::uint64_t>(at + 2 * kStripe + i));
    }
    state = shift(shift(state) ^ second) ^ third;
  }
  for (; left >= 8; at += 8, left -= 8) state = _mm_crc32_u64(state, load<std::uint64_t>(at));
  auto narrow = static_cast<std::uint32_t>(state);
  for (; left > 0; ++at, --left) narrow = _mm_crc32_u8(narrow, *at);
  return ~narrow;
}
#endif

}  // namespace

std::uint32_t crc32c_by_table(ByteView bytes, std::uint32_t crc) {
  return crc_by_table(kCastagnoli, bytes, crc);
}

std::uint32_t crc32c(ByteView bytes, std::uint32_t crc) {
#if defined(__x86_64__)
  static const bool hardware = __builtin_cpu_supports("sse4.2") != 0;
  if (hardware) return crc32c_by_hardware(bytes, crc);
#endif
  return crc32c_by_table(bytes, crc);
}

}  // namespace counterpart
