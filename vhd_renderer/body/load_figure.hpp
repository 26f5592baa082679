// Reads a rigged figure from GLB, glTF, FBX or what else assimp knows.
#pragma once

#include <filesystem>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/body/figure.hpp"

namespace counterpart {

// Fails with a sentence if the file is missing, cut, too large, or holds no skinned mesh with a skeleton. The pose
// stored in the file becomes the bind pose; a figure in centimetres is brought to metres and stood on the floor.
Result<Figure> load_figure(const std::filesystem::path& path);

}  // namespace counterpart
