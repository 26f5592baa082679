// A saved pose to start from: init.json {frame, tx, ty, tz, qw, qx, qy, qz}, x_cam = R x_model + t, metres.
#pragma once

#include <filesystem>

#include <Eigen/Geometry>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

[[nodiscard]] Result<Eigen::Isometry3d> read_start_file(const std::filesystem::path& path);

}  // namespace counterpart
