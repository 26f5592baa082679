#include "stage/film/sequence.hpp"

#include <cstdio>
#include <system_error>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "protocol/vocabulary/pose_eigen.hpp"

namespace counterpart::stage {
namespace {

nlohmann::ordered_json to_json(const Intrinsics& k) {
  return {{"width", k.width}, {"height", k.height}, {"fx", k.fx},    {"fy", k.fy},
          {"cx", k.cx},       {"cy", k.cy},         {"dist", k.dist}};
}

std::string csv(const Pose& pose, char separator) {
  char text[256];
  std::snprintf(text, sizeof text, "%.9g%c%.9g%c%.9g%c%.9g%c%.9g%c%.9g%c%.9g", pose.p[0], separator, pose.p[1],
                separator, pose.p[2], separator, pose.q[0], separator, pose.q[1], separator, pose.q[2], separator,
                pose.q[3]);
  return text;
}

Error write_failure(const std::filesystem::path& path) {
  return {ErrorCode::io, "Cannot write " + path.string() + "; is the folder writable and the disk not full?"};
}

}  // namespace

std::string truth_line(const Truth& truth) {
  const Pose pose = to_pose(truth.view.X_CB);
  nlohmann::ordered_json line{
      {"frame", truth.stamp.frame_id},
      {"capture_ns", truth.stamp.capture_ns},
      {"X_CB", {{"p", pose.p}, {"q", pose.q}}},
      {"board", {{"squares", truth.board.squares}, {"square_size_m", truth.board.square_size_m}}},
      {"intrinsics", to_json(truth.view.intrinsics)},
      {"occupancy", truth.occupancy},
      {"holds_piece", truth.holds_piece},
      {"hand_share", truth.hand_share},
      {"edges_hidden", truth.edges_hidden},
      {"motion_px", truth.motion_px}};
  if (!truth.board_present) {
    for (const char* key : {"X_CB", "board", "occupancy", "holds_piece", "hand_share", "edges_hidden"}) line.erase(key);
  }
  for (const ObjectTruth& object : truth.objects) {
    const Pose object_pose = to_pose(object.X_CO);
    line["objects"].push_back({{"name", object.name},
                               {"X_CO", {{"p", object_pose.p}, {"q", object_pose.q}}},
                               {"edges_hidden", object.edges_hidden}});
  }
  return line.dump();
}

Result<SequenceWriter> SequenceWriter::create(const std::filesystem::path& folder, const Scenario& scenario) {
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  if (trouble) return failure(ErrorCode::io, "Cannot make the folder " + folder.string() + ": " + trouble.message());
  if (std::filesystem::exists(folder / "frame_00000.png")) {
    return failure(ErrorCode::refused,
                   folder.string() + " holds a sequence already; choose another folder or remove it.");
  }
  SequenceWriter writer;
  writer.folder_ = folder;
  writer.board_present_ = !scenario.no_board;
  writer.truth_.open(folder / "truth.jsonl");
  std::ofstream camera(folder / "camera.json");
  if (!writer.truth_ || !(camera << to_json(scenario.intrinsics).dump(2) << "\n")) {
    return tl::make_unexpected(write_failure(folder));
  }
  // The sequence itself is about the board, or about the first object where there is no board.
  std::vector<std::filesystem::path> folders;
  if (writer.board_present_) folders.push_back(folder);
  for (const ObjectPlan& plan : scenario.objects) {
    folders.push_back(folders.empty() ? folder : folder / "objects" / plan.name);
    std::filesystem::create_directories(folders.back(), trouble);
    std::ofstream model(folders.back() / "model.obj");
    if (!(model << to_obj(polygon_model(plan.kind, plan.size_m)))) {
      return tl::make_unexpected(write_failure(folders.back() / "model.obj"));
    }
  }
  for (const std::filesystem::path& each : folders) {
    writer.tracks_.push_back({each, std::ofstream(each / "poses.csv")});
    if (!(writer.tracks_.back().poses << "frame,tx,ty,tz,qw,qx,qy,qz\n")) {
      return tl::make_unexpected(write_failure(each / "poses.csv"));
    }
  }
  return writer;
}

Result<void> SequenceWriter::write_pose(Track& track, unsigned long frame, const Eigen::Isometry3d& X_CM) {
  const Pose pose = to_pose(X_CM);
  if (!begun_) {
    std::ofstream init(track.folder / "init.json");
    const nlohmann::ordered_json first{{"frame", frame},  {"tx", pose.p[0]}, {"ty", pose.p[1]}, {"tz", pose.p[2]},
                                       {"qw", pose.q[0]}, {"qx", pose.q[1]}, {"qy", pose.q[2]}, {"qz", pose.q[3]}};
    if (!(init << first.dump(2) << "\n")) return tl::make_unexpected(write_failure(track.folder / "init.json"));
  }
  if (!(track.poses << frame << "," << csv(pose, ',') << "\n")) {
    return tl::make_unexpected(write_failure(track.folder / "poses.csv"));
  }
  return {};
}

Result<void> SequenceWriter::write(const Shot& shot) {
  const auto frame = static_cast<unsigned long>(shot.truth.stamp.frame_id);
  char name[32];
  std::snprintf(name, sizeof name, "frame_%05lu.png", frame);
  // OpenCV's own choice of filter and strategy is twice as fast as level 1 with zlib's, and the files are smaller.
  if (!cv::imwrite((folder_ / name).string(), shot.image_bgr)) {
    return tl::make_unexpected(write_failure(folder_ / name));
  }
  std::vector<Eigen::Isometry3d> poses;
  if (board_present_) poses.push_back(shot.truth.view.X_CB);
  for (const ObjectTruth& object : shot.truth.objects) poses.push_back(object.X_CO);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (const Result<void> written = write_pose(tracks_[i], frame, poses[i]); !written) return written;
  }
  begun_ = true;
  if (!(truth_ << truth_line(shot.truth) << "\n")) return tl::make_unexpected(write_failure(folder_ / "truth.jsonl"));
  return {};
}

}  // namespace counterpart::stage
