// Any text: no crash, and a position that was understood is the same after it was written and read again.
#include <cstdlib>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterpart;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const Rules* rules : {&international_rules, &english_rules}) {
    const auto position = read_fen(*rules, text);
    if (!position) continue;
    const auto again = read_fen(*rules, write_fen(*rules, *position));
    if (!again || !(*again == *position)) std::abort();
    const auto hub = read_hub_position(*rules, write_hub_position(*rules, *position));
    if (!hub || !(*hub == *position)) std::abort();
  }
  static_cast<void>(read_move(international_rules, start_position(international_rules), text));
  return 0;
}
