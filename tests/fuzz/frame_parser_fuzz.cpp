// Any bytes, cut anywhere: no crash, and never a message that is larger than its type permits.
#include <cstdlib>

#include "protocol/framing/frame_parser.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterpart;
  FrameParser parser;
  ByteView left(data, size);
  while (!left.empty()) {
    const std::size_t piece = std::min<std::size_t>(left.size(), 1 + left[0] % 64);
    for (ByteView part = left.first(piece); !part.empty();) {
      part = part.subspan(parser.feed(part));
      for (auto message = parser.next(); message && *message; message = parser.next()) {
        if ((*message)->body.size() > max_length((*message)->header.type)) std::abort();
      }
      if (!parser.next()) return 0;
    }
    left = left.subspan(piece);
  }
  return 0;
}
