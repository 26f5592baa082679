// Any bytes as pictures in H.264 that follow each other: no crash, and what was shown has the size that was announced.
// A picture: its number of bytes (u16), how far back it builds (u8), its bytes.
#include <algorithm>
#include <cstdlib>

#include "protocol/codec/bytes.hpp"
#include "protocol/h264/h264.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterpart;
  const auto decoder = make_h264_decoder();
  VideoFrame coded;
  coded.codec = PixelCodec::h264;
  coded.width = coded.height = 64;
  for (ByteView rest(data, size); rest.size() > 3;) {
    const std::size_t length = std::min<std::size_t>(load<std::uint16_t>(rest.data()), rest.size() - 3);
    ++coded.stamp.frame_id;
    coded.stride = rest[2];
    const ByteView picture = rest.subspan(3, length);
    coded.bytes.assign(picture.begin(), picture.end());
    rest = rest.subspan(3 + length);
    if (coded.bytes.empty()) continue;  // the codec of messages lets none through
    const auto raw = decoder->decode(coded);
    if (raw && *raw && (*raw)->bytes.size() != 64 * 64 * 3) std::abort();
  }
  return 0;
}
