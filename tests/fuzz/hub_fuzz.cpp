// A stranger who may send any messages, well sealed, in any order: the server stays on its feet.
#include <cstring>

#include "protocol/session/hub.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterpart;
  LinkOptions options;
  options.role = Role::tracker;
  Hub hub(Hub::End::server, options, size % 2 == 0 ? "" : "a token of sixteen");
  const auto id = hub.accepted(1);
  std::int64_t now_ns = 1;
  ByteView left(data, size);
  while (left.size() >= 4 && id) {
    Header header;
    header.type = left[0];
    header.flags = left[1] & 1;
    header.seq = left[1] >> 1;
    const std::size_t length = std::min<std::size_t>(left.size() - 4, left[2] + 256U * (left[3] % 8));
    const ByteView body = left.subspan(4, length);
    const HeaderBytes sealed = seal(header, body);
    for (ByteView bytes : {ByteView(sealed), body}) {
      while (!bytes.empty() && hub.wants_read(*id)) {
        const auto room = hub.parser(*id).room();
        const std::size_t count = std::min(room.size(), bytes.size());
        std::memcpy(room.data(), bytes.data(), count);
        hub.read(*id, count, now_ns);
        bytes = bytes.subspan(count);
      }
    }
    hub.tick(now_ns += 10'000'000);
    while (hub.next_to_write(*id, now_ns)) {
    }
    left = left.subspan(4 + length);
  }
  hub.take_inbound();
  return 0;
}
