// tracker_server calibrate: camera.json from a film of the game board or of a chessboard.
#include "tracker_server/camera/calibrate.hpp"

#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "tracker_server/camera/camera.hpp"
#include "tracker_server/camera/camera_json.hpp"
#include "tracker_server/programs/programs.hpp"

namespace counterpart {
namespace {

struct CalibrateArguments {
  std::string source;
  std::string out;
  int squares = 10;
  int most_sights = 30;
};

Result<void> run(const CalibrateArguments& arguments) {
  auto camera = open_camera(arguments.source, Pace::lockstep);
  if (!camera) return tl::make_unexpected(camera.error());
  std::vector<BoardSight> sights;
  int width = 0, height = 0, frames = 0;
  while (static_cast<int>(sights.size()) < arguments.most_sights) {
    auto next = (*camera)->next();
    if (!next) return tl::make_unexpected(next.error());
    if (!*next) break;
    const cv::Mat& picture = (*next)->image_bgr;
    if (frames++ > 0 && (picture.cols != width || picture.rows != height))
      return failure(ErrorCode::bad_format, "The pictures of " + arguments.source + " differ in size.");
    width = picture.cols;
    height = picture.rows;
    auto sight = sight_board(picture, arguments.squares);
    // Frames in which hardly anything moved would only count the same sight twice.
    if (!sight || (!sights.empty() && movement_px(sights.back(), *sight) < 0.015 * width)) continue;
    sights.push_back(std::move(*sight));
  }
  const auto result = calibrate(sights, width, height);
  if (!result) return tl::make_unexpected(result.error());
  if (const auto written = write_camera_json(arguments.out, result->camera); !written) return written;
  const nlohmann::ordered_json json = {{"sights", sights.size()},
                                       {"rms_px", result->rms_px},
                                       {"fx", result->camera.fx},
                                       {"fx_sigma", result->focal_sigma_px}};
  std::cout << json.dump() << '\n';
  return {};
}

}  // namespace

void add_calibrate(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command = app.add_subcommand("calibrate", "Measure a camera from a film of the board");
  command->add_option("source", arguments->source, "SEQUENCE, film, folder of pictures or camera")->required();
  command->add_option("--out", arguments->out, "camera.json to write")->required();
  command->add_option("--squares", arguments->squares, "Squares a side")->check(CLI::Range(4, 12));
  command->add_option("--sights", arguments->most_sights, "Pictures to use at most")->check(CLI::Range(3, 200));
  command->callback([arguments, &exit_code] {
    if (const auto done = run(*arguments); !done) {
      spdlog::error("{}", done.error().message);
      exit_code = 1;
    }
  });
}

}  // namespace counterpart
