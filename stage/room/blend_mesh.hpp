// Smooth organic bodies from a few capsules that melt into each other.
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "vhd_renderer/draw/mesh.hpp"

namespace counterpart::stage {

struct Capsule {
  Eigen::Vector3f a_m, b_m;  // ends of the axis
  float radius_a_m, radius_b_m;
};

// The same capsule in the frame that X leads to.
Capsule moved(const Capsule& capsule, const Eigen::Isometry3f& X);

// Distance to the capsule's surface, negative inside.
float distance_m(const Capsule& capsule, const Eigen::Vector3f& p_m);

// The surface on which the smooth union of the capsules is zero (surface nets). blend_m: how far apart they still flow
// together; cell_m: size of the mesh's facets. uv is (x, y) in metres.
MeshData blended(const std::vector<Capsule>& capsules, float blend_m, float cell_m);

}  // namespace counterpart::stage
