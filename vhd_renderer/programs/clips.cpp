#include "vhd_renderer/programs/clips.hpp"

#include <cstdio>

#include <CLI/CLI.hpp>

#include "vhd_renderer/motion/clip.hpp"

namespace counterpart {

void add_clips(CLI::App& app) {
  app.add_subcommand("clips", "Lists the keyframe clips: name, seconds")->callback([] {
    for (const auto& [name, clip] : clip_library()) {
      std::printf("%-14s %.1f\n", name.c_str(), static_cast<double>(clip.seconds));
    }
  });
}

}  // namespace counterpart
