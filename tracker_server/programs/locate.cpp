// tracker_server locate: one picture, one JSON object.
#include "tracker_server/locate/locate.hpp"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <spdlog/spdlog.h>

#include "tracker_server/camera/camera_json.hpp"
#include "tracker_server/pieces/appearance.hpp"
#include "tracker_server/pieces/board_view.hpp"
#include "tracker_server/pieces/scan_segments.hpp"
#include "tracker_server/programs/corners.hpp"
#include "tracker_server/programs/programs.hpp"

namespace counterpart {
namespace {

struct LocateArguments {
  std::string image;
  int squares = 10;
  std::string camera_json;
  std::string init = "auto";
  std::string method = "appearance";
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

// The corners as they are given: the first one is that of row 0, column 0.
LocatedBoard board_at(const std::array<double, 8>& corners_px, int squares) {
  const auto n = static_cast<float>(squares);
  const cv::Point2f from[] = {{0, 0}, {n, 0}, {n, n}, {0, n}};
  cv::Point2f to[4];
  for (std::size_t i = 0; i < 4; ++i)
    to[i] = {static_cast<float>(corners_px[2 * i]), static_cast<float>(corners_px[2 * i + 1])};
  const cv::Matx33d H = cv::getPerspectiveTransform(from, to);
  LocatedBoard board;
  board.H = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(H.val);
  return board;
}

std::vector<CellSight> read_squares(const cv::Mat& picture, const LocatedBoard& board,
                                    const LocateArguments& arguments) {
  const auto to_pixel = [&](double column, double row) { return board.to_pixel(column, row); };
  const BoardView view = view_board(picture, arguments.squares, to_pixel);
  const Reading reading = read_appearance(look_at_cells(view), arguments.squares, {});
  if (arguments.method == "appearance") return reading.cells;
  // The paper's way does not say which squares are played on.
  cv::Mat1b grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  const int parity = reading.look.playable_parity;
  const auto values = scan_values(grey, arguments.squares, to_pixel);
  const auto rule = scan_rule(values, arguments.squares, "", parity);
  if (!rule) return std::vector<CellSight>(reading.cells.size());
  return read_scan(values, arguments.squares, rule->threshold, rule->pieces_dark, parity);
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
  std::optional<std::array<double, 8>> given;
  if (arguments.init.rfind("corners=", 0) == 0) {
    const auto corners = corners_from(arguments.init.substr(std::string("corners=").size()));
    if (!corners) return tl::make_unexpected(corners.error());
    given = *corners;
  } else if (arguments.init != "auto") {
    return failure(ErrorCode::invalid_argument, "--init " + arguments.init + ": auto or corners=x0,y0,...,x3,y3");
  }
  const auto start = std::chrono::steady_clock::now();
  const auto board = given ? board_at(*given, arguments.squares) : locate_board(picture, arguments.squares);
  const auto found = std::chrono::steady_clock::now();
  std::vector<CellSight> cells;
  if (board) cells = read_squares(picture, *board, arguments);
  const auto end = std::chrono::steady_clock::now();
  nlohmann::ordered_json json;
  json["found"] = board.has_value();
  json["corners"] = nlohmann::json::array();
  json["squares"] = nlohmann::json::array();
  if (board) {
    if (given) {
      for (std::size_t i = 0; i < 4; ++i) json["corners"].push_back({(*given)[2 * i], (*given)[2 * i + 1]});
    } else {
      for (const auto& corner : board->corners(arguments.squares)) json["corners"].push_back({corner.x(), corner.y()});
    }
    for (int row = 0; row < arguments.squares; ++row) {
      auto names = nlohmann::ordered_json::array();
      for (int col = 0; col < arguments.squares; ++col)
        names.push_back(name_of(cells[static_cast<std::size_t>(row * arguments.squares + col)].reading));
      json["squares"].push_back(names);
    }
  }
  json["ms"] = std::chrono::duration<double, std::milli>(end - start).count();
  json["read_ms"] = std::chrono::duration<double, std::milli>(end - found).count();
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
  command
      ->add_option("--init", arguments->init,
                   "auto, or corners=x0,y0,...,x3,y3 of the playing surface, clockwise from row 0, column 0")
      ->capture_default_str();
  command
      ->add_option("--pieces", arguments->method,
                   "how squares are read: appearance, or scan-segments as in the paper of 2000")
      ->check(CLI::IsMember({"appearance", "scan-segments"}))
      ->capture_default_str();
  command->callback([arguments, &exit_code] {
    if (const auto done = locate(*arguments); !done) {
      spdlog::error("{}", done.error().message);
      exit_code = done.error().code == ErrorCode::invalid_argument ? 2 : 1;
    }
  });
}

}  // namespace counterpart
