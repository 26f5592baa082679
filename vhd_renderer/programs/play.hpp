// `vhd_renderer play`: a script of commands, offline, the same bytes each time.
#pragma once

namespace CLI {
class App;
}

namespace counterpart {

void add_play(CLI::App& app, int& exit_code);

}  // namespace counterpart
