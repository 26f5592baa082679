// tracker_server locate: one picture, one JSON object.
#include "tracker_server/locate/locate.hpp"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <spdlog/spdlog.h>

#include "tracker_server/camera/camera_json.hpp"
#include "tracker_server/pieces/appearance.hpp"
#include "tracker_server/pieces/board_view.hpp"
#include "tracker_server/programs/programs.hpp"

namespace counterpart {
namespace {

struct LocateArguments {
  std::string image;
  int squares = 10;
  std::string camera_json;
};

const char* name_of(CellReading reading) {
  switch (reading) {
    case CellReading::empty:
      return "empty";
    case CellReading::dark:
      return "dark";
    case CellReading::light:
      return "light";
    case CellReading::piece:
      return "piece";
    case CellReading::unknown:
      break;
  }
  return "unknown";
}

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
  std::vector<CellSight> cells;
  if (board) {
    const auto to_pixel = [&](double column, double row) { return board->to_pixel(column, row); };
    const BoardView view = view_board(picture, arguments.squares, to_pixel);
    cells = read_appearance(look_at_cells(view), arguments.squares, {}).cells;
  }
  nlohmann::ordered_json json;
  json["found"] = board.has_value();
  json["corners"] = nlohmann::json::array();
  json["squares"] = nlohmann::json::array();
  if (board) {
    for (const auto& corner : board->corners(arguments.squares)) json["corners"].push_back({corner.x(), corner.y()});
    for (int row = 0; row < arguments.squares; ++row) {
      auto names = nlohmann::ordered_json::array();
      for (int col = 0; col < arguments.squares; ++col)
        names.push_back(name_of(cells[static_cast<std::size_t>(row * arguments.squares + col)].reading));
      json["squares"].push_back(names);
    }
  }
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
