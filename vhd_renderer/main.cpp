// The Virtual Human Director: draws the human and his pieces into the camera's picture and takes commands over TCP.
#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "vhd_renderer/programs/clips.hpp"
#include "vhd_renderer/programs/play.hpp"
#include "vhd_renderer/programs/serve.hpp"

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("vhd_renderer"));
  CLI::App app("Renders the virtual human", "vhd_renderer");
  app.set_version_flag("--version", "vhd_renderer " COUNTERPART_VERSION);
  app.require_subcommand(1);
  int exit_code = 0;
  counterpart::add_serve(app, exit_code);
  counterpart::add_play(app, exit_code);
  counterpart::add_clips(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return exit_code;
}
