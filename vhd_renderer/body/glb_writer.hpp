// A figure as a GLB file (glTF 2.0 binary): meshes with skin, morphs and embedded PNG textures.
#pragma once

#include <filesystem>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/body/figure.hpp"

namespace counterpart {

// Writes to a neighbour first and renames, so that a reader never sees half a file.
Result<void> write_glb(const Figure& figure, const std::filesystem::path& path);

}  // namespace counterpart
