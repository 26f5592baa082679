// The subcommands of vhp. Each adds itself to the command line; the chosen one sets `exit_code`.
#pragma once

namespace CLI {
class App;
}

namespace counterpart::vhp {

void add_monitor(CLI::App& app, int& exit_code);
void add_send(CLI::App& app, int& exit_code);
void add_record(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);
void add_script(CLI::App& app, int& exit_code);
void add_capture(CLI::App& app, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
void add_certificate(CLI::App& app, int& exit_code);
void add_completion(CLI::App& app, int& exit_code);

}  // namespace counterpart::vhp
