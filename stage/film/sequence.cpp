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
  std::snprintf(text, sizeof text, "%.9g%c%.9g%c%.9g%c%.9g%c%.9g%c%.9g%c%.9g", pose.p[0], separator, pose.p[1], separator,
                pose.p[2], separator, pose.q[0], separator, pose.q[1], separator, pose.q[2], separator, pose.q[3]);
  return text;
}

Error write_failure(const std::filesystem::path& path) {
  return {ErrorCode::io, "Cannot write " + path.string() + "; is the folder writable and the disk not full?"};
}

}  // namespace

std::string truth_line(const Truth& truth) {
  const Pose pose = to_pose(truth.view.X_CB);
  const nlohmann::ordered_json line{{"frame", truth.stamp.frame_id},
                                    {"capture_ns", truth.stamp.capture_ns},
                                    {"p_CB", pose.p},
                                    {"q_CB", pose.q},
                                    {"playing_surface_m", truth.playing_surface_m},
                                    {"intrinsics", to_json(truth.view.intrinsics)},
                                    {"occupancy", truth.occupancy},
                                    {"hand_share", truth.hand_share},
                                    {"edges_hidden", truth.edges_hidden},
                                    {"motion_px", truth.motion_px}};
  return line.dump();
}

Result<SequenceWriter> SequenceWriter::create(const std::filesystem::path& folder, const Scenario& scenario) {
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  if (trouble) return failure(ErrorCode::io, "Cannot make the folder " + folder.string() + ": " + trouble.message());
  if (std::filesystem::exists(folder / "frame_00000.png")) {
    return failure(ErrorCode::refused, folder.string() + " holds a sequence already; choose another folder or remove it.");
  }
  SequenceWriter writer;
  writer.folder_ = folder;
  writer.poses_.open(folder / "poses.csv");
  writer.truth_.open(folder / "truth.jsonl");
  std::ofstream camera(folder / "camera.json");
  if (!(writer.poses_ << "frame,tx,ty,tz,qw,qx,qy,qz\n") || !writer.truth_ ||
      !(camera << to_json(scenario.intrinsics).dump(2) << "\n")) {
    return tl::make_unexpected(write_failure(folder));
  }
  return writer;
}

Result<void> SequenceWriter::write(const Shot& shot) {
  const auto frame = static_cast<unsigned long>(shot.truth.stamp.frame_id);
  char name[32];
  std::snprintf(name, sizeof name, "frame_%05lu.png", frame);
  if (!cv::imwrite((folder_ / name).string(), shot.image_bgr, {cv::IMWRITE_PNG_COMPRESSION, 1})) {
    return tl::make_unexpected(write_failure(folder_ / name));
  }
  const Pose pose = to_pose(shot.truth.view.X_CB);
  if (frame == 0) {
    std::ofstream init(folder_ / "init.json");
    const nlohmann::ordered_json first{{"frame", 0},          {"tx", pose.p[0]}, {"ty", pose.p[1]}, {"tz", pose.p[2]},
                                       {"qw", pose.q[0]}, {"qx", pose.q[1]}, {"qy", pose.q[2]}, {"qz", pose.q[3]}};
    if (!(init << first.dump(2) << "\n")) return tl::make_unexpected(write_failure(folder_ / "init.json"));
  }
  if (!(poses_ << frame << "," << csv(pose, ',') << "\n") || !(truth_ << truth_line(shot.truth) << "\n")) {
    return tl::make_unexpected(write_failure(folder_ / "poses.csv"));
  }
  return {};
}

}  // namespace counterpart::stage
