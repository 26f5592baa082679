// `vhd_renderer serve`
#pragma once

namespace CLI {
class App;
}

namespace counterpart {

void add_serve(CLI::App& app, int& exit_code);

}  // namespace counterpart
