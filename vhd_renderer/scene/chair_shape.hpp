// The chair that the virtual human sits on.
#pragma once

#include "vhd_renderer/draw/mesh.hpp"

namespace counterpart {

// A plain wooden chair in its own frame C: on the floor under the hips of whoever sits on it, y the way it faces.
MeshData chair_shape();

}  // namespace counterpart
