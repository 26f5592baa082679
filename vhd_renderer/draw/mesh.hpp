// Triangles to draw, and the simple bodies that scenes are made of.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace counterpart {

// Metres, in the mesh's own frame O. Triangles run counter-clockwise seen from outside.
struct MeshData {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Eigen::Vector3f> normals;  // unit, one a position
  std::vector<Eigen::Vector2f> uvs;      // one a position; v = 0 at the top row of the texture
  std::vector<std::uint32_t> triangles;  // three indices each
};

// Centred at the origin; full lengths. uv runs over each face once.
MeshData box_mesh(const Eigen::Vector3f& size_m);

// In the plane z = 0, facing +z, centred, cut into cells so that a lens's distortion bends it properly. u grows with x,
// v falls with y.
MeshData plane_mesh(float size_x_m, float size_y_m, int cells_x, int cells_y);

// A body of revolution round z from a profile of (radius, z), given from the bottom outside to the top; radius 0 closes
// it. A corner of the profile is smooth unless the point is given twice.
MeshData lathe_mesh(const std::vector<Eigen::Vector2f>& profile_m, int segments);

// Appends `other`, moved by `offset_m`.
void append(MeshData& mesh, const MeshData& other, const Eigen::Vector3f& offset_m);

}  // namespace counterpart
