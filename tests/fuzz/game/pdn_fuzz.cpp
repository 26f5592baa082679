// Any text: no crash, and games that were understood are the same after they were written and read again.
#include <cstdlib>

#include "game_controller/notation/pdn_read.hpp"
#include "game_controller/notation/pdn_write.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterpart;
  const auto games = read_pdn({reinterpret_cast<const char*>(data), size});
  if (!games) return 0;
  for (const PdnGame& game : *games) {
    const std::string text = write_pdn(game);
    const auto again = read_pdn(text);
    if (!again || again->size() != 1) std::abort();
    if (!(again->front().record.moves() == game.record.moves())) std::abort();
    if (!(again->front().remarks == game.remarks)) std::abort();
    if (write_pdn(again->front()) != text) std::abort();
  }
  return 0;
}
