#include "tracker_server/pipeline/pose_log.hpp"

#include <utility>

#include <Eigen/Core>

#include "protocol/vocabulary/pose_eigen.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart {

const char* csv_word(TrackStatus status) {
  switch (status) {
    case TrackStatus::ok:
    case TrackStatus::relocalised:
      return "ok";
    case TrackStatus::coasting:
      return "coasting";
    case TrackStatus::lost:
      break;
  }
  return "lost";
}

Result<void> PoseLog::open(const std::string& file) {
  if (file.empty()) return {};
  file_ = file;
  out_.open(file, std::ios::trunc);
  out_.precision(9);
  out_ << "frame,tx,ty,tz,qw,qx,qy,qz,status,rms_px,fx,ms,x0,y0,x1,y1,x2,y2,x3,y3\n";
  if (!out_) return failure(ErrorCode::io, "Cannot write " + file + ".");
  return {};
}

void PoseLog::add(const PoseEstimate& pose, const Intrinsics& camera, const std::optional<BoardGeometry>& board,
                  double ms) {
  if (!out_.is_open()) return;
  out_ << pose.stamp.frame_id;
  if (!usable(pose)) {
    out_ << ",,,,,,,,lost,,," << ms << ",,,,,,,,\n";
    return;
  }
  for (const double value : pose.X_CB.p) out_ << ',' << value;
  for (const double value : pose.X_CB.q) out_ << ',' << value;
  out_ << ',' << csv_word(pose.status) << ',' << pose.rms_px << ',' << camera.fx << ',' << ms;
  if (!board) {
    out_ << ",,,,,,,,\n";
    return;
  }
  const Eigen::Isometry3d X_CB = to_eigen(pose.X_CB);
  const double half = 0.5 * board->squares * board->square_size_m;
  for (const auto& [x, y] : {std::pair{-half, half}, {half, half}, {half, -half}, {-half, -half}}) {
    const Eigen::Vector2d p = project(camera, X_CB * Eigen::Vector3d(x, y, 0));
    out_ << ',' << p.x() << ',' << p.y();
  }
  out_ << '\n';
}

Result<void> PoseLog::close() {
  if (!out_.is_open()) return {};
  out_.close();
  if (!out_) return failure(ErrorCode::io, "Cannot write all of " + file_ + "; is the disk full?");
  return {};
}

}  // namespace counterpart
