// Any text: no crash, and a line that was understood keeps its command after it was written and read again. Whole
// conversations, too: the engine must answer or ignore them, never fall over.
#include <cstdlib>
#include <sstream>

#include "game_controller/links/hub_engine.hpp"
#include "game_controller/links/hub_line.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace counterpart;
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const auto line = read_hub_line(text)) {
    const auto again = read_hub_line(write_hub_line(*line));
    if (!again || again->command != line->command) std::abort();
  }
  if (size > 400 || text.find("hash-mb") != std::string::npos) return 0;  // large tables are slow, not wrong
  std::istringstream in("hub\nset-param name=hash-mb value=1\ninit\nlevel depth=2\n" + text + "\nstop\nquit\n");
  std::ostringstream out;
  run_hub_engine(in, out);
  return 0;
}
