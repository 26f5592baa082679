#include "vhd_renderer/programs/clips.hpp"

#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

#include "vhd_renderer/motion/clip_file.hpp"

namespace counterpart {

void add_clips(CLI::App& app, int& exit_code) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("clips", "Lists the keyframe clips: name, seconds");
  command->add_option("--clips", *folder, "a folder with more clips: .bvh, .gltf, .glb, .json");
  command->callback([folder, &exit_code] {
    const auto clips = clips_with_folder(*folder);
    if (!clips) {
      spdlog::error("{}", clips.error().message);
      exit_code = 1;
      return;
    }
    for (const auto& [name, clip] : *clips) {
      std::printf("%-14s %.1f\n", name.c_str(), static_cast<double>(clip.seconds));
    }
  });
}

}  // namespace counterpart
