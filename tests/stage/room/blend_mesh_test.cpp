#include "stage/room/blend_mesh.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace counterpart::stage {
namespace {

TEST(BlendMesh, ACapsuleHasItsVolumeAndFacesOutwards) {
  const MeshData mesh = blended({{{0, 0, 0}, {0.1f, 0, 0}, 0.03f, 0.03f}}, 0.001f, 0.003f);
  double volume = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const auto p = [&](std::size_t k) { return mesh.positions_m[mesh.triangles[i + k]].cast<double>().eval(); };
    volume += p(0).dot(p(1).cross(p(2))) / 6;
  }
  const double expected = 3.14159 * 0.03 * 0.03 * 0.1 + 4.0 / 3 * 3.14159 * 0.03 * 0.03 * 0.03;
  EXPECT_NEAR(volume, expected, 0.03 * expected);  // facets cut corners
}

TEST(BlendMesh, NormalsPointAwayFromTheAxis) {
  const MeshData mesh = blended({{{0, 0, 0}, {0.1f, 0, 0}, 0.03f, 0.03f}}, 0.001f, 0.004f);
  for (std::size_t i = 0; i < mesh.positions_m.size(); ++i) {
    const Eigen::Vector3f p = mesh.positions_m[i];
    const Eigen::Vector3f axis(std::clamp(p.x(), 0.f, 0.1f), 0, 0);
    EXPECT_GT(mesh.normals[i].dot((p - axis).normalized()), 0.98);
  }
}

}  // namespace
}  // namespace counterpart::stage
