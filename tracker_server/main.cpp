#include <exception>

#include <CLI/CLI.hpp>
#include <opencv2/core/utility.hpp>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "tracker_server/programs/programs.hpp"

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("tracker_server"));
  spdlog::set_pattern("%H:%M:%S %^%l%$ %v");

  cv::setNumThreads(1);  // frames are small: hand-over to other threads costs more than it saves

  CLI::App app("Finds and follows a draughts board in a camera's pictures and reads the pieces on it.");
  app.set_version_flag("--version", COUNTERPART_VERSION);
  app.require_subcommand(1);
  int exit_code = 0;
  counterpart::add_serve(app, exit_code);
  counterpart::add_track(app, exit_code);
  counterpart::add_locate(app, exit_code);
  counterpart::add_calibrate(app, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
  return exit_code;
}
