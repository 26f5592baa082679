// tracker_server track: the poses of a film, one line a frame.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include "protocol/daemon/step_times.hpp"
#include "protocol/daemon/stop_signal.hpp"
#include "protocol/vocabulary/pose_eigen.hpp"
#include "tracker_server/camera/camera.hpp"
#include "tracker_server/camera/camera_json.hpp"
#include "tracker_server/pipeline/pose_log.hpp"
#include "tracker_server/pose/board_tracker.hpp"
#include "tracker_server/pose/gradient_fit.hpp"
#include "tracker_server/pose/model_tracker.hpp"
#include "tracker_server/pose/start_file.hpp"
#include "tracker_server/programs/corners.hpp"
#include "tracker_server/programs/programs.hpp"

namespace counterpart {
namespace {

struct TrackArguments {
  std::string sequence;
  std::string poses;
  std::string model;
  int squares = 10;
  double square_size_m = 0.04;
  std::string played_on = "dark";
  std::string init = "auto";
  std::string focal = "fixed";
  std::string predictor = "first";
  std::string optimizer = "gauss-newton";
  std::string camera_json;
  std::string report;
};

struct Sight {
  PoseEstimate pose;
  Intrinsics camera;
};

// What is followed, whichever it is: the next picture to the pose in it.
using Follow = std::function<Sight(const Frame&)>;

PoseEstimate estimate_of(TrackStatus status, const Eigen::Isometry3d& X, double rms_px, const FrameStamp& stamp) {
  PoseEstimate pose;
  pose.stamp = stamp;
  pose.status = status;
  pose.X_CB = to_pose(X);
  pose.rms_px = static_cast<float>(rms_px);
  return pose;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

BoardGeometry board_of(const TrackArguments& arguments) {
  BoardGeometry board;
  board.squares = arguments.squares;
  board.square_size_m = arguments.square_size_m;
  board.played_on = arguments.played_on == "light" ? SquareColour::light : SquareColour::dark;
  return board;
}

Result<std::optional<Intrinsics>> intrinsics_of(const TrackArguments& arguments, const Camera& camera) {
  if (arguments.camera_json.empty()) return camera.intrinsics();
  const auto given = read_camera_json(arguments.camera_json);
  if (!given) return tl::make_unexpected(given.error());
  return std::optional<Intrinsics>(*given);
}

// The pose in the file that --init names, or beside the pictures; nothing if there is none and none is asked for.
Result<std::optional<Eigen::Isometry3d>> start_pose(const TrackArguments& arguments) {
  std::filesystem::path file = arguments.init;
  if (arguments.init == "auto") file = std::filesystem::path(arguments.sequence) / "init.json";
  if (arguments.init == "auto" && !std::filesystem::exists(file)) return std::optional<Eigen::Isometry3d>();
  const auto X_CB = read_start_file(file);
  if (!X_CB) return tl::make_unexpected(X_CB.error());
  return std::optional<Eigen::Isometry3d>(*X_CB);
}

Result<Follow> follow_board(const TrackArguments& arguments, const Camera& camera, Predictor predictor,
                            const Optimizer& optimizer) {
  BoardTrackerOptions options;
  options.board = board_of(arguments);
  const auto intrinsics = intrinsics_of(arguments, camera);
  if (!intrinsics) return tl::make_unexpected(intrinsics.error());
  options.camera = *intrinsics;
  options.focal = arguments.focal == "estimate" ? FocalMode::estimate : FocalMode::fixed;
  options.predictor = predictor;
  options.optimizer = optimizer;
  const auto tracker = std::make_shared<BoardTracker>(options);

  const std::string corners_prefix = "corners=";
  if (arguments.init.rfind(corners_prefix, 0) == 0) {
    const auto corners = corners_from(arguments.init.substr(corners_prefix.size()));
    if (!corners) return tl::make_unexpected(corners.error());
    std::array<Eigen::Vector2d, 4> points;
    for (std::size_t i = 0; i < 4; ++i) points[i] = Eigen::Vector2d((*corners)[2 * i], (*corners)[2 * i + 1]);
    tracker->start_at(points);
  } else {
    const auto start = start_pose(arguments);
    if (!start) return tl::make_unexpected(start.error());
    if (*start) tracker->start_at(**start);
  }
  return [tracker](const Frame& frame) -> Sight {
    const Pyramid pyramid = build_pyramid(frame.image_bgr, 3);
    const TrackedBoard seen = tracker->track(frame.image_bgr, pyramid, frame.stamp.capture_ns);
    return {estimate_of(seen.status, seen.X_CB, seen.fit.rms_px, frame.stamp), seen.camera};
  };
}

Result<Follow> follow_model(const TrackArguments& arguments, const Camera& camera, Predictor predictor,
                            const Optimizer& optimizer) {
  auto model = read_obj_model(arguments.model);
  if (!model) return tl::make_unexpected(model.error());
  const auto intrinsics = intrinsics_of(arguments, camera);
  if (!intrinsics) return tl::make_unexpected(intrinsics.error());
  if (!*intrinsics)
    return failure(ErrorCode::invalid_argument,
                   "A model needs a known camera: put camera.json beside the pictures or give --camera.");
  const auto start = start_pose(arguments);
  if (!start) return tl::make_unexpected(start.error());
  if (!*start)
    return failure(ErrorCode::invalid_argument,
                   "A model needs a pose to start from: put init.json beside the pictures or give --init FILE.");
  const auto tracker = std::make_shared<ModelTracker>(std::move(*model), **intrinsics, predictor, optimizer);
  tracker->start_at(**start);
  return [tracker, known = **intrinsics](const Frame& frame) -> Sight {
    const TrackedModel seen = tracker->track(build_pyramid(frame.image_bgr, 3), frame.stamp.capture_ns);
    return {estimate_of(seen.status, seen.X_CM, seen.fit.rms_px, frame.stamp), known};
  };
}

Result<Follow> follow(const TrackArguments& arguments, const Camera& camera) {
  const auto predictor = predictor_from(arguments.predictor);
  if (!predictor) return tl::make_unexpected(predictor.error());
  const auto optimizer = optimizer_from(arguments.optimizer);
  if (!optimizer) return tl::make_unexpected(optimizer.error());
  return arguments.model.empty() ? follow_board(arguments, camera, *predictor, *optimizer)
                                 : follow_model(arguments, camera, *predictor, *optimizer);
}

Result<void> track(const TrackArguments& arguments) {
  auto camera = open_camera(arguments.sequence, Pace::lockstep);
  if (!camera) return tl::make_unexpected(camera.error());
  const auto next_pose = follow(arguments, **camera);
  if (!next_pose) return tl::make_unexpected(next_pose.error());
  std::optional<BoardGeometry> board;
  if (arguments.model.empty()) board = board_of(arguments);

  PoseLog poses;
  if (auto opened = poses.open(arguments.poses); !opened) return opened;

  StepTimes times;
  std::vector<double> rms_px;
  std::map<std::string, int> counts{{"ok", 0}, {"coasting", 0}, {"lost", 0}};
  int frames = 0;
  double focal_px = 0;
  catch_stop_signals();
  while (!stop_requested()) {
    auto next = (*camera)->next();
    if (!next) return tl::make_unexpected(next.error());
    if (!*next) break;
    const Frame& frame = **next;
    const auto start = std::chrono::steady_clock::now();
    const Sight seen = (*next_pose)(frame);
    const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    poses.add(seen.pose, seen.camera, board, ms);
    times.add("ms", ms);
    ++frames;
    ++counts[csv_word(seen.pose.status)];
    if (usable(seen.pose)) {
      rms_px.push_back(static_cast<double>(seen.pose.rms_px));
      focal_px = seen.camera.fx;
    }
  }
  if (auto closed = poses.close(); !closed) return closed;
  const nlohmann::json ms = frames > 0 ? times.report().at("ms") : nlohmann::json::object();
  spdlog::info("{} frames: {} ok, {} coasting, {} lost; median {:.2f} ms", frames, counts["ok"], counts["coasting"],
               counts["lost"], ms.value("median", 0.0));

  if (!arguments.report.empty()) {
    const nlohmann::ordered_json report = {{"frames", frames},
                                           {"ok", counts["ok"]},
                                           {"coasting", counts["coasting"]},
                                           {"lost", counts["lost"]},
                                           {"ms_median", ms.value("median", 0.0)},
                                           {"ms_p95", ms.value("p95", 0.0)},
                                           {"rms_px_median", median(rms_px)},
                                           {"fx", focal_px}};
    std::ofstream file(arguments.report);
    file << report.dump(2) << '\n';
    if (!file.flush()) return failure(ErrorCode::io, "Cannot write " + arguments.report + ".");
  }
  if (counts["ok"] == 0) {
    const std::string in_any = " was not found in any of the " + std::to_string(frames) + " frames; ";
    return failure(ErrorCode::not_found,
                   arguments.model.empty()
                       ? "The board" + in_any + "is --squares right? --init corners=... tells where it is."
                       : "The model" + in_any + "is the pose to start from within a few pixels of the first picture?");
  }
  return {};
}

}  // namespace

void add_track(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<TrackArguments>();
  CLI::App* command =
      app.add_subcommand("track", "Write the pose of the board, or of a model, in every frame of a film");
  command->add_option("sequence", arguments->sequence, "SEQUENCE folder, folder of pictures, film or stream")
      ->required();
  command->add_option("--poses", arguments->poses, "CSV file to write")->required();
  command->add_option("--squares", arguments->squares, "Squares a side")->check(CLI::Range(4, 12));
  command->add_option("--square-size", arguments->square_size_m, "Side of a square, metres")
      ->check(CLI::Range(0.001, 10.0));
  command->add_option("--played-on", arguments->played_on, "Colour of the squares that are played on")
      ->check(CLI::IsMember({"dark", "light"}));
  command->add_option("--init", arguments->init, "auto, a file with a pose, or corners=x0,y0,...,x3,y3");
  command->add_option("--focal", arguments->focal, "fixed or estimate; estimated anyway if the camera is not known")
      ->check(CLI::IsMember({"fixed", "estimate"}));
  command->add_option("--predictor", arguments->predictor, "none, first or second order")
      ->check(CLI::IsMember({"none", "first", "second"}));
  command->add_option("--model", arguments->model, "Wavefront OBJ to follow instead of a board; metres, faces outward");
  command->add_option("--optimizer", arguments->optimizer, "gauss-newton, or nlopt:ALGORITHM on the gradient image");
  command->add_option("--camera", arguments->camera_json, "camera.json to use instead of the one beside the pictures");
  command->add_option("--report", arguments->report, "JSON file for the summary");
  command->callback([arguments, &exit_code] {
    if (const auto done = track(*arguments); !done) {
      spdlog::error("{}", done.error().message);
      exit_code = done.error().code == ErrorCode::invalid_argument ? 2 : 1;
    }
  });
}

}  // namespace counterpart
