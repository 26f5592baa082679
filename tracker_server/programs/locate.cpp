// tracker_server locate: one picture, one JSON object.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <spdlog/spdlog.h>

#include "tracker_server/camera/camera_json.hpp"
#include "tracker_server/locate/locate.hpp"
#include "tracker_server/programs/programs.hpp"

namespace counterpart {
namespace {

struct LocateArguments {
  std::string image;
  int squares = 10;
  std::string camera_json;
};

Result<void> locate(const LocateArguments& arguments) {
  if (!std::filesystem::is_regular_file(arguments.image))
    return failure(ErrorCode::not_found, "There is no picture " + arguments.image + ".");
  const cv::Mat picture = cv::imread(arguments.image, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  if (picture.empty())
    return failure(ErrorCode::bad_format, "Cannot decode the picture " + arguments.image + "; it may be cut off.");
  if (!arguments.camera_json.empty()) {
    const auto camera = read_camera_json(arguments.camera_json);
    if (!camera) return tl::make_unexpected(camera.error());
  }
  const auto start = std::chrono::steady_clock::now();
  const auto board = locate_board(picture, arguments.squares);
  nlohmann::ordered_json json;
  json["found"] = board.has_value();
  json["corners"] = nlohmann::json::array();
  json["squares"] = nlohmann::json::array();
  if (board)
    for (const auto& corner : board->corners(arguments.squares)) json["corners"].push_back({corner.x(), corner.y()});
  json["ms"] = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  std::cout << json.dump() << '\n';
  return {};
}

}  // namespace

void add_locate(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<LocateArguments>();
  CLI::App* command = app.add_subcommand("locate", "Find a board in one picture and read it");
  command->add_option("image", arguments->image, "PNG or JPEG picture")->required();
  command->add_option("--squares", arguments->squares, "Squares a side")->check(CLI::Range(4, 12));
  command->add_option("--camera", arguments->camera_json, "camera.json of the camera that took it");
  command->callback([arguments, &exit_code] {
    if (const auto done = locate(*arguments); !done) {
      spdlog::error("{}", done.error().message);
      exit_code = 1;
    }
  });
}

}  // namespace counterpart
