// Clips from motion files, by assimp: BVH and glTF (.bvh, .gltf, .glb), and the JSON form of clip.hpp (.json). A motion
// of any skeleton is brought into the terms of a clip (how pelvis, trunk and head turn, where the hands are in lengths
// of the arm), so that every figure can play it; legs and the way through the room are left out. Joints are known by
// H-Anim, Mixamo, MakeHuman or VRM names (joint_names.hpp); the file's rest pose has to stand upright.
#pragma once

#include <filesystem>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/motion/clip.hpp"

namespace counterpart {

// Named after the file. The first animation counts. What moves faster than a person, or farther than a person bends, is
// held back. Fails if the file is over 64 MB or ten minutes, or is none of these.
Result<Clip> read_clip_file(const std::filesystem::path& path);

// The clips made here and those of a folder, at most 256; an empty path: none besides. Fails with the file that cannot
// be used, has a name that a command cannot give (1 to 40 of a-z, 0-9, _ and -), or one that is taken.
Result<ClipLibrary> clips_with_folder(const std::filesystem::path& folder);

}  // namespace counterpart
