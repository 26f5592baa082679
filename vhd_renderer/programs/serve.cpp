#include "vhd_renderer/programs/serve.hpp"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include "protocol/daemon/picture_memory.hpp"
#include "protocol/daemon/stop_signal.hpp"
#include "vhd_renderer/pipeline/serve.hpp"

namespace counterpart {

void add_serve(CLI::App& app, int& exit_code) {
  struct Arguments {
    RendererOptions renderer;
    std::string blend = "alpha";
    double patience_s = 0;
  };
  auto arguments = std::make_shared<Arguments>();
  RendererOptions& renderer = arguments->renderer;
  CLI::App* command =
      app.add_subcommand("serve", "The daemon: composites the virtual human into the tracker's pictures");
  command->add_option("--tracker", renderer.tracker, "HOST:PORT of tracker_server")->capture_default_str();
  command->add_option("--listen", renderer.listen, "HOST:PORT for directors who command the human (usual port: 7402)");
  command->add_option("--web", renderer.web, "HOST:PORT of the mirror page (usual port: 8080)");
  command->add_option("--output", renderer.outputs, "FILE.mp4 or a folder for pictures; may be given several times");
  command->add_option("--character", renderer.character, "a character's name, a GLB file, or mannequin")
      ->capture_default_str();
  command->add_option("--clips", renderer.clips, "a folder with more clips: .bvh, .gltf, .glb, .json");
  command->add_option("--blend", arguments->blend, "alpha, or black-key as in the paper")
      ->check(CLI::IsMember({"alpha", "black-key"}))
      ->capture_default_str();
  command->add_option("--blur", renderer.composite.blur_px, "of the camera, put on the drawn part, pixels")
      ->check(CLI::Range(0.0, 3.0))
      ->capture_default_str();
  command->add_option("--noise", renderer.composite.noise, "of the camera, put on the drawn part, grey levels")
      ->check(CLI::Range(0.0, 20.0))
      ->capture_default_str();
  command->add_flag("--lockstep", renderer.lockstep, "composite every frame, in order");
  command->add_option("--token-file", renderer.link.token_file,
                      "shared with the tracker, for other addresses than loopback");
  command->add_option("--tls-file", renderer.link.tls_file, "TLS 1.3, with this file of vhp certificate");
  command->add_option("--patience", arguments->patience_s, "seconds to wait for a tracker at the start; 0: for ever")
      ->capture_default_str();
  command->add_option("--record", renderer.link.record_file, "capture everything on the link, MCAP");
  command->add_option("--report", renderer.report_file, "write counts and times here at the end, JSON");
  command->callback([arguments, &exit_code] {
    RendererOptions& options = arguments->renderer;
    options.composite.blend = arguments->blend == "alpha" ? Blend::alpha : Blend::black_key;
    options.patience_ns = static_cast<std::int64_t>(arguments->patience_s * 1e9);
    options.link.role = Role::renderer;
    options.link.software = "vhd_renderer " COUNTERPART_VERSION;
    options.link.lockstep = options.lockstep;
    catch_stop_signals();
    keep_picture_memory();
    if (auto served = counterpart::serve(options); !served) {
      spdlog::error("{}", served.error().message);
      exit_code = 1;
    }
  });
}

}  // namespace counterpart
