#include "tracker_server/pose/start_file.hpp"

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

namespace counterpart {

Result<Eigen::Isometry3d> read_start_file(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return failure(ErrorCode::not_found, "Cannot open the starting pose " + path.string() + ".");
  const auto json = nlohmann::json::parse(file, nullptr, false);
  double value[7];
  constexpr const char* names[7] = {"tx", "ty", "tz", "qw", "qx", "qy", "qz"};
  for (int i = 0; i < 7; ++i) {
    const bool there = json.is_object() && json.contains(names[i]) && json[names[i]].is_number();
    value[i] = there ? json[names[i]].get<double>() : std::nan("");
    if (!std::isfinite(value[i]))
      return failure(ErrorCode::bad_format, path.string() + ": \"" + names[i] +
                                                "\" must be a finite number; expected {frame, tx, ty, tz, qw, "
                                                "qx, qy, qz}.");
  }
  const Eigen::Quaterniond q(value[3], value[4], value[5], value[6]);
  if (!(q.norm() > 0.5 && q.norm() < 2))
    return failure(ErrorCode::bad_format, path.string() + ": qw, qx, qy, qz is not a unit quaternion.");
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = q.normalized().toRotationMatrix();
  X.translation() = Eigen::Vector3d(value[0], value[1], value[2]);
  return X;
}

}  // namespace counterpart
