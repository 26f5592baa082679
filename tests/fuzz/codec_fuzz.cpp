// Any body of any type: no crash, and what was understood says the same after it was written and read again.
#include <cstdlib>

#include "protocol/codec/codec.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterpart;
  if (size < 1) return 0;
  const auto type = static_cast<MessageType>(data[0]);
  if (!is_known(data[0])) return 0;
  const auto message = decode(type, ByteView(data + 1, size - 1));
  if (!message) return 0;
  const auto body = encode(*message);
  if (!body) return 0;  // longer written than it was read, over the limit
  const auto again = decode(type, *body);
  if (!again || !(*again == *message)) std::abort();
  return 0;
}
