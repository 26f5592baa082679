// The program `stage`: a simulated room with a camera, a board and a real player.
#include <cstdlib>

#include <CLI/CLI.hpp>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "protocol/daemon/picture_memory.hpp"
#include "protocol/daemon/stop_signal.hpp"
#include "stage/programs/render.hpp"
#include "stage/programs/serve.hpp"

namespace {

int finish(const counterpart::Result<void>& result) {
  if (result) return 0;
  spdlog::error("{}", result.error().message);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  // Mesa's software driver then draws in the thread that asks: a tenth less of work for each frame, and the cores are
  // others' to use. Whoever sets it is obeyed.
  setenv("LP_NUM_THREADS", "0", 0);
  counterpart::keep_picture_memory();
  using namespace counterpart::stage;
  spdlog::set_default_logger(spdlog::stderr_logger_mt("stage"));
  spdlog::set_pattern("%H:%M:%S.%e %n %l: %v");
  counterpart::catch_stop_signals();

  CLI::App app("A simulated room: a camera, a board, a real player, and the exact truth about them.");
  app.set_version_flag("--version", std::string("stage ") + COUNTERPART_VERSION);
  app.require_subcommand(1);

  RenderOptions render;
  CLI::App* render_command = app.add_subcommand("render", "Write a scenario as pictures with their truth");
  render_command->add_option("scenario", render.scenario, "JSON file, see stage/scenarios")->required();
  render_command->add_option("--out", render.out, "Folder to make")->required();
  render_command->add_option("--seed", render.seed, "Instead of the scenario's");
  render_command->add_option("--frames", render.frames, "Instead of the scenario's")->check(CLI::PositiveNumber);
  render_command->add_option("--from", render.from, "Pass over so many frames first, without drawing them")
      ->check(CLI::NonNegativeNumber);
  render_command->add_flag("--masks", render.masks, "Also mask_%05d.png: where the player's arm is seen");

  ServeOptions serve;
  CLI::App* serve_command = app.add_subcommand("serve", "Be a camera for a tracker, and the player in front of it");
  serve_command->add_option("--listen", serve.listen, "HOST:PORT")->capture_default_str();
  serve_command->add_option("--scenario", serve.scenario, "JSON file; without it a game at a plain table");
  serve_command->add_option("--frames", serve.frames, "Stop after so many; 0: until stopped")->capture_default_str();
  serve_command->add_option("--truth", serve.truth, "Write a line of JSON a frame to this file");
  serve_command->add_option("--token-file,--token", serve.token_file, "Needed to listen on anything but loopback");
  serve_command->add_option("--tls-file", serve.tls_file, "TLS 1.3, with this file of vhp certificate");
  serve_command->add_option("--seed", serve.seed, "Instead of the scenario's");
  serve_command->add_flag("--lockstep", serve.lockstep, "Next frame only when the last one is done; no clock");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return finish(*render_command ? run_render(render, counterpart::stop_requested)
                                : run_serve(serve, counterpart::stop_requested));
}
