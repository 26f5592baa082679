// vhp: watches, scripts, records and replays the protocol between tracker and renderer.
#include <csignal>

#include <CLI/CLI.hpp>

#include "protocol/daemon/stop_signal.hpp"
#include "protocol/vhp/commands.hpp"
#include "protocol/vhp/common.hpp"

int main(int argc, char** argv) {
  using namespace counterpart::vhp;
  CLI::App app("Watches, scripts, records and replays the link between tracker and renderer.", "vhp");
  app.set_version_flag("--version", "vhp " COUNTERPART_VERSION);
  app.require_subcommand(1);
  int exit_code = kFine;
  add_monitor(app, exit_code);
  add_send(app, exit_code);
  add_record(app, exit_code);
  add_replay(app, exit_code);
  add_script(app, exit_code);
  add_capture(app, exit_code);
  add_export(app, exit_code);
  add_certificate(app, exit_code);
  add_completion(app, exit_code);
  counterpart::catch_stop_signals();
  std::signal(SIGPIPE, SIG_IGN);  // a reader of our output that has gone is seen by the write
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kFine : kWrongUsage;
  }
  return exit_code;
}
