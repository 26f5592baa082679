// Any text as a scenario: understood or refused with its line.
#include "protocol/vhp/script.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(counterpart::vhp::parse_script(text, "fuzz"));
  return 0;
}
