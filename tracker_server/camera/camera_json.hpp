// camera.json: {width, height, fx, fy, cx, cy, dist: [k1, k2, p1, p2, k3]}, pixels; dist may be left out.
#pragma once

#include <filesystem>

#include "protocol/vocabulary/intrinsics.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// Fails on missing or non-finite numbers, on sizes outside 1..65535 and on focal lengths that are not positive.
[[nodiscard]] Result<Intrinsics> read_camera_json(const std::filesystem::path& path);
[[nodiscard]] Result<void> write_camera_json(const std::filesystem::path& path, const Intrinsics& camera);

// Empty if the numbers describe a camera; otherwise what is wrong with them.
[[nodiscard]] std::string fault_of(const Intrinsics& camera);

}  // namespace counterpart
