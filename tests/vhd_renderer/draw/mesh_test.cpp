#include "vhd_renderer/draw/mesh.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace counterpart {
namespace {

// The volume that the triangles enclose: right only if all of them face outwards and nothing is open.
double enclosed_volume(const MeshData& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const Eigen::Vector3d a = mesh.positions_m[mesh.triangles[i]].cast<double>();
    const Eigen::Vector3d b = mesh.positions_m[mesh.triangles[i + 1]].cast<double>();
    const Eigen::Vector3d c = mesh.positions_m[mesh.triangles[i + 2]].cast<double>();
    sum += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

void expect_normals_agree(const MeshData& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const auto& p = mesh.positions_m;
    const Eigen::Vector3f face =
        (p[mesh.triangles[i + 1]] - p[mesh.triangles[i]]).cross(p[mesh.triangles[i + 2]] - p[mesh.triangles[i]]);
    for (int k = 0; k < 3; ++k) EXPECT_GT(face.dot(mesh.normals[mesh.triangles[i + static_cast<std::size_t>(k)]]), 0);
  }
}

TEST(Mesh, BoxIsClosedAndFacesOutwards) {
  const MeshData box = box_mesh({1, 2, 3});
  EXPECT_NEAR(enclosed_volume(box), 6, 1e-5);
  expect_normals_agree(box);
}

TEST(Mesh, LatheOfACylinderHasItsVolume) {
  const MeshData cylinder = lathe_mesh({{0, 0}, {1, 0}, {1, 0}, {1, 2}, {1, 2}, {0, 2}}, 64);
  EXPECT_NEAR(enclosed_volume(cylinder), 2 * 3.14159, 0.02);  // 64 sides: 0.16 % less than the circle
  expect_normals_agree(cylinder);
}

TEST(Mesh, PlaneFacesUp) {
  const MeshData plane = plane_mesh(2, 1, 4, 2);
  EXPECT_EQ(plane.triangles.size(), 4u * 2 * 6);
  expect_normals_agree(plane);
}

}  // namespace
}  // namespace counterpart
