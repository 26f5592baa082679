// CRC32C (Castagnoli; RFC 3720 appendix B.4), in hardware where the processor has SSE 4.2.
#pragma once

#include <cstdint>

#include "protocol/codec/bytes.hpp"

namespace counterpart {

// `crc` is the checksum of what came before, 0 at the start: crc32c(b, crc32c(a)) is the checksum of a and b together.
std::uint32_t crc32c(ByteView bytes, std::uint32_t crc = 0);

// The same by tables (slicing by 8), for processors without the instruction, and to test the other against.
std::uint32_t crc32c_by_table(ByteView bytes, std::uint32_t crc = 0);

}  // namespace counterpart
