// tracker_server track: the poses of a film, one line a frame.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <spdlog/spdlog.h>

#include "protocol/daemon/step_times.hpp"
#include "protocol/daemon/stop_signal.hpp"
#include "protocol/vocabulary/pose_eigen.hpp"
#include "tracker_server/camera/camera.hpp"
#include "tracker_server/camera/camera_json.hpp"
#include "tracker_server/pipeline/debug_view.hpp"
#include "tracker_server/pipeline/pose_log.hpp"
#include "tracker_server/pose/board_tracker.hpp"
#include "tracker_server/pose/gradient_fit.hpp"
#include "tracker_server/pose/object_tracker.hpp"
#include "tracker_server/pose/start_file.hpp"
#include "tracker_server/programs/corners.hpp"
#include "tracker_server/programs/objects.hpp"
#include "tracker_server/programs/programs.hpp"

namespace counterpart {
namespace {

struct TrackArguments {
  std::string sequence;
  std::string poses;
  std::string model;
  ObjectArguments objects;
  int squares = 10;
  double square_size_m = 0.04;
  std::string played_on = "dark";
  std::string init = "auto";
  std::string focal = "fixed";
  std::string lens = "fixed";
  std::string predictor = "first";
  std::string optimizer = "gauss-newton";
  std::string camera_json;
  std::string report;
  std::string debug;
};

struct NamedPose {
  std::string name;
  PoseEstimate pose;
};

struct Sight {
  PoseEstimate pose;
  Intrinsics camera;
  std::vector<NamedPose> objects;  // the same ones in the same order in every picture
  std::vector<DebugView> debug;    // if asked for
};

// What is followed, whichever it is: the next picture to the poses in it.
using Follow = std::function<Sight(const Frame&)>;

// How the poses of one thing came out.
struct Tally {
  std::map<std::string, int> counts{{"ok", 0}, {"coasting", 0}, {"lost", 0}};
  std::vector<double> rms_px;

  void add(const PoseEstimate& pose) {
    ++counts[csv_word(pose.status)];
    if (usable(pose)) rms_px.push_back(static_cast<double>(pose.rms_px));
  }
};

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

const std::string corners_prefix = "corners=";

bool has_corners(const TrackArguments& arguments) {
  return arguments.init.rfind(corners_prefix, 0) == 0;
}

// The pose in the file that --init names, or beside the pictures; nothing if there is none and none is asked for.
Result<std::optional<Eigen::Isometry3d>> start_pose(const TrackArguments& arguments) {
  if (has_corners(arguments)) return std::optional<Eigen::Isometry3d>();
  std::filesystem::path file = arguments.init;
  if (arguments.init == "auto") file = std::filesystem::path(arguments.sequence) / "init.json";
  if (arguments.init == "auto" && !std::filesystem::exists(file)) return std::optional<Eigen::Isometry3d>();
  const auto X_CB = read_start_file(file);
  if (!X_CB) return tl::make_unexpected(X_CB.error());
  return std::optional<Eigen::Isometry3d>(*X_CB);
}

auto camera_is_needed() {
  return failure(ErrorCode::invalid_argument,
                 "A model needs a known camera: put camera.json beside the pictures or give --camera.");
}

std::shared_ptr<ObjectTracker> object_tracker(ObjectGroups groups, Predictor predictor, const Optimizer& optimizer) {
  auto tracker = std::make_shared<ObjectTracker>(predictor, optimizer);
  for (std::vector<ObjectToTrack>& group : groups.others) tracker->add(std::move(group));
  return tracker;
}

std::vector<NamedPose> poses_of(const std::vector<TrackedObject>& objects, const FrameStamp& stamp) {
  std::vector<NamedPose> poses;
  for (const TrackedObject& object : objects)
    poses.push_back({object.name, estimate_of(object.status, object.X_CM, object.rms_px, stamp)});
  return poses;
}

void add_debug_views(const ObjectTracker& objects, const Intrinsics& camera, const FrameStamp& stamp,
                     std::vector<DebugView>& views) {
  for (const ObjectTracker::Group& group : objects.groups())
    if (group.seen.status != TrackStatus::lost)
      views.push_back(debug_view(group.tracker.model(), group.seen.X_CM, camera, group.seen.fit, stamp));
}

Result<Follow> follow_board(const TrackArguments& arguments, const Camera& camera, Predictor predictor,
                            const Optimizer& optimizer) {
  BoardTrackerOptions options;
  options.board = board_of(arguments);
  const auto intrinsics = intrinsics_of(arguments, camera);
  if (!intrinsics) return tl::make_unexpected(intrinsics.error());
  options.camera = *intrinsics;
  options.estimate_lens = arguments.lens == "estimate";
  options.focal = arguments.focal == "estimate" ? FocalMode::estimate : FocalMode::fixed;
  options.predictor = predictor;
  options.optimizer = optimizer;
  const auto start = start_pose(arguments);
  if (!start) return tl::make_unexpected(start.error());
  auto groups = objects_to_track(arguments.objects, arguments.sequence, "board");
  if (!groups) return tl::make_unexpected(groups.error());
  std::vector<std::pair<std::string, Eigen::Isometry3d>> fixtures;  // names and X_BM
  for (ObjectToTrack& object : groups->with_main) {
    if (!*start)
      return failure(ErrorCode::invalid_argument,
                     "What is rigid to the board needs the board's pose in the first picture: put init.json beside the "
                     "pictures or give --init FILE.");
    fixtures.emplace_back(object.name, (**start).inverse() * object.X_CM);
    options.fixtures.push_back({std::move(object.model), fixtures.back().second});
  }
  if (!options.camera && !arguments.objects.objects.empty()) return camera_is_needed();
  const auto tracker = std::make_shared<BoardTracker>(options);
  const auto others = object_tracker(*std::move(groups), predictor, optimizer);

  if (has_corners(arguments)) {
    const auto corners = corners_from(arguments.init.substr(corners_prefix.size()));
    if (!corners) return tl::make_unexpected(corners.error());
    std::array<Eigen::Vector2d, 4> points;
    for (std::size_t i = 0; i < 4; ++i) points[i] = Eigen::Vector2d((*corners)[2 * i], (*corners)[2 * i + 1]);
    tracker->start_at(points);
  } else if (*start) {
    tracker->start_at(**start);
  }
  return [tracker, others, fixtures, debug = !arguments.debug.empty()](const Frame& frame) -> Sight {
    const TrackedBoard board = tracker->track(frame.image_bgr, frame.stamp.capture_ns);
    Sight sight{estimate_of(board.status, board.X_CB, board.fit.rms_px, frame.stamp), board.camera, {}, {}};
    for (const auto& [name, X_BM] : fixtures)
      sight.objects.push_back({name, estimate_of(board.status, board.X_CB * X_BM, board.fit.rms_px, frame.stamp)});
    if (!others->groups().empty()) {
      const auto seen = others->track(build_pyramid(frame.image_bgr, 3), board.camera, frame.stamp.capture_ns);
      for (NamedPose& object : poses_of(seen, frame.stamp)) sight.objects.push_back(std::move(object));
    }
    if (debug) {
      if (board.status != TrackStatus::lost)
        sight.debug.push_back(debug_view(tracker->model(), board.X_CB, board.camera, board.fit, frame.stamp));
      add_debug_views(*others, board.camera, frame.stamp, sight.debug);
    }
    return sight;
  };
}

Result<Follow> follow_model(const TrackArguments& arguments, const Camera& camera, Predictor predictor,
                            const Optimizer& optimizer) {
  auto model = read_obj_model(arguments.model);
  if (!model) return tl::make_unexpected(model.error());
  const auto intrinsics = intrinsics_of(arguments, camera);
  if (!intrinsics) return tl::make_unexpected(intrinsics.error());
  if (!*intrinsics) return camera_is_needed();
  const auto start = start_pose(arguments);
  if (!start) return tl::make_unexpected(start.error());
  if (!*start)
    return failure(ErrorCode::invalid_argument,
                   "A model needs a pose to start from: put init.json beside the pictures or give --init FILE.");
  auto groups = objects_to_track(arguments.objects, arguments.sequence, "model");
  if (!groups) return tl::make_unexpected(groups.error());
  groups->with_main.insert(groups->with_main.begin(), {"model", std::move(*model), **start});
  groups->others.insert(groups->others.begin(), std::exchange(groups->with_main, {}));
  const auto tracker = object_tracker(*std::move(groups), predictor, optimizer);
  return [tracker, known = **intrinsics, debug = !arguments.debug.empty()](const Frame& frame) -> Sight {
    auto poses =
        poses_of(tracker->track(build_pyramid(frame.image_bgr, 3), known, frame.stamp.capture_ns), frame.stamp);
    Sight sight{poses.front().pose, known, {}, {}};
    sight.objects.assign(std::next(poses.begin()), poses.end());
    if (debug) add_debug_views(*tracker, known, frame.stamp, sight.debug);
    return sight;
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

Result<void> save_debug_picture(const std::string& folder, const Frame& frame, const std::vector<DebugView>& views) {
  cv::Mat picture = frame.image_bgr.clone();
  for (const DebugView& view : views) draw_debug_view(view, picture);
  std::ostringstream name;
  name << "frame_" << std::setw(5) << std::setfill('0') << frame.stamp.frame_id << ".png";
  const std::string file = (std::filesystem::path(folder) / name.str()).string();
  if (!cv::imwrite(file, picture)) return failure(ErrorCode::io, "Cannot write " + file + ".");
  return {};
}

// poses.csv, box: poses.box.csv
std::string object_file(const std::string& poses, const std::string& name) {
  std::filesystem::path file = poses;
  return file.replace_filename(file.stem().string() + "." + name + file.extension().string()).string();
}

nlohmann::ordered_json summary_of(const Tally& tally) {
  return {{"ok", tally.counts.at("ok")},
          {"coasting", tally.counts.at("coasting")},
          {"lost", tally.counts.at("lost")},
          {"rms_px_median", median(tally.rms_px)}};
}

Result<void> track(const TrackArguments& arguments) {
  auto camera = open_camera(arguments.sequence, Pace::lockstep);
  if (!camera) return tl::make_unexpected(camera.error());
  const auto next_pose = follow(arguments, **camera);
  if (!next_pose) return tl::make_unexpected(next_pose.error());
  std::optional<BoardGeometry> board;
  if (arguments.model.empty()) board = board_of(arguments);

  if (!arguments.debug.empty()) {
    std::error_code error;
    std::filesystem::create_directories(arguments.debug, error);
    if (error)
      return failure(ErrorCode::io, "Cannot make the folder " + arguments.debug + ": " + error.message() + ".");
  }
  PoseLog poses;
  if (auto opened = poses.open(arguments.poses); !opened) return opened;

  StepTimes times;
  Tally main;
  std::map<std::string, PoseLog> object_poses;
  std::map<std::string, Tally> objects;
  int frames = 0;
  Intrinsics last_camera;
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
    if (!arguments.debug.empty())
      if (auto drawn = save_debug_picture(arguments.debug, frame, seen.debug); !drawn) return drawn;
    main.add(seen.pose);
    if (usable(seen.pose)) last_camera = seen.camera;
    for (const auto& [name, pose] : seen.objects) {
      PoseLog& log = object_poses[name];
      if (objects.count(name) == 0)
        if (auto opened = log.open(object_file(arguments.poses, name)); !opened) return opened;
      log.add(pose, seen.camera, std::nullopt, ms);
      objects[name].add(pose);
    }
  }
  if (auto closed = poses.close(); !closed) return closed;
  for (auto& [name, log] : object_poses)
    if (auto closed = log.close(); !closed) return closed;
  const nlohmann::json ms = frames > 0 ? times.report().at("ms") : nlohmann::json::object();
  spdlog::info("{} frames: {} ok, {} coasting, {} lost; median {:.2f} ms", frames, main.counts["ok"],
               main.counts["coasting"], main.counts["lost"], ms.value("median", 0.0));
  for (auto& [name, tally] : objects)
    spdlog::info("  {}: {} ok, {} coasting, {} lost", name, tally.counts["ok"], tally.counts["coasting"],
                 tally.counts["lost"]);

  if (!arguments.report.empty()) {
    nlohmann::ordered_json report = {{"frames", frames}};
    report.update(summary_of(main));
    report["ms_median"] = ms.value("median", 0.0);
    report["ms_p95"] = ms.value("p95", 0.0);
    report["fx"] = last_camera.fx;
    report["cx"] = last_camera.cx;
    report["cy"] = last_camera.cy;
    report["dist"] = last_camera.dist;
    for (const auto& [name, tally] : objects) report["objects"][name] = summary_of(tally);
    std::ofstream file(arguments.report);
    file << report.dump(2) << '\n';
    if (!file.flush()) return failure(ErrorCode::io, "Cannot write " + arguments.report + ".");
  }
  if (main.counts["ok"] == 0) {
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
  command
      ->add_option("--lens", arguments->lens,
                   "fixed or estimate: principal point and distortion, too, once the board was seen from several sides")
      ->check(CLI::IsMember({"fixed", "estimate"}));
  command->add_option("--predictor", arguments->predictor, "none, first or second order")
      ->check(CLI::IsMember({"none", "first", "second"}));
  command->add_option("--model", arguments->model, "Wavefront OBJ to follow instead of a board; metres, faces outward");
  command->add_option("--object", arguments->objects.objects,
                      "Follow this one, too: a folder with model.obj and init.json, or its name under "
                      "SEQUENCE/objects; its poses go to OUT.NAME.csv. May be given again");
  command->add_option("--rigid", arguments->objects.rigid,
                      "NAME,NAME,...: these objects, the board or the model keep their places to each other and are "
                      "fitted as one. May be given again");
  command->add_option("--optimizer", arguments->optimizer, "gauss-newton, or nlopt:ALGORITHM on the gradient image");
  command->add_option("--camera", arguments->camera_json, "camera.json to use instead of the one beside the pictures");
  command->add_option("--report", arguments->report, "JSON file for the summary");
  command->add_option("--debug", arguments->debug,
                      "Folder for a PNG of every frame with the model and the edge points over it");
  command->callback([arguments, &exit_code] {
    if (const auto done = track(*arguments); !done) {
      spdlog::error("{}", done.error().message);
      exit_code = done.error().code == ErrorCode::invalid_argument ? 2 : 1;
    }
  });
}

}  // namespace counterpart
