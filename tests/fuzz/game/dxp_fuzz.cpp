// Any message: no crash, and one that was understood is the same after it was written and read again.
#include <cstdlib>

#include "game_controller/links/dxp_message.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterpart;
  const auto message = read_dxp({reinterpret_cast<const char*>(data), size});
  if (!message) return 0;
  const std::string text = write_dxp(*message);
  if (text.size() > longest_dxp_message) std::abort();
  const auto again = read_dxp(text);
  if (!again || write_dxp(*again) != text) std::abort();
  return 0;
}
