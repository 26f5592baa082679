// The subcommands of tracker_server; each adds itself and sets exit_code when it has run (0 fine, 1 failed, 2 usage).
#pragma once

namespace CLI {
class App;
}

namespace counterpart {

void add_serve(CLI::App& app, int& exit_code);
void add_track(CLI::App& app, int& exit_code);
void add_locate(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);

}  // namespace counterpart
