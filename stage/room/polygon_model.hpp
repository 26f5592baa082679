// Things of flat faces that stand in the room and can be tracked: a box, a table, a chair. Frame O: origin at the
// centre, z up. The same faces are drawn, written as OBJ and asked for what they hide.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vhd_renderer/draw/mesh.hpp"

namespace counterpart::stage {

enum class ObjectKind : std::uint8_t { box = 1, table = 2, chair = 3 };

// An upright block. Where it stands against another one, it has no face.
struct Block {
  Eigen::Vector3d centre_O{0, 0, 0};
  Eigen::Vector3d size_m{0, 0, 0};
  bool no_top = false, no_bottom = false;
};

struct PolygonModel {
  std::vector<Block> blocks;
  std::vector<Eigen::Vector3d> vertices_O;
  std::vector<std::vector<int>> faces;  // of vertices, counterclockwise seen from outside
};

// How large such a thing usually is, from side to side, from front to back and in height.
Eigen::Vector3d usual_size_m(ObjectKind kind);

PolygonModel polygon_model(ObjectKind kind, const Eigen::Vector3d& size_m);

// Wavefront OBJ, metres.
std::string to_obj(const PolygonModel& model);

// Flat faces, cut into cells of at most `cell_m` so that a lens bends them properly.
MeshData mesh_of(const PolygonModel& model, double cell_m);

// Is a block of it between both points? Frame O. What lies on its surface is not.
bool comes_between(const PolygonModel& model, const Eigen::Vector3d& a_O, const Eigen::Vector3d& b_O);

}  // namespace counterpart::stage
