#include "vhd_renderer/body/mannequin.hpp"

#include "tests/vhd_renderer/body/figure_check.hpp"

namespace counterpart {
namespace {

TEST(Mannequin, IsASoundFigureWithEveryJointThatMotionNeeds) {
  const Figure figure = mannequin();
  expect_sound(figure);
  for (const std::string& name : needed_joints()) EXPECT_GE(joint_index(figure, name), 0) << name;
}

TEST(Mannequin, FacesPointOutwards) {
  const Figure figure = mannequin();
  const FigurePart& body = figure.parts.front();
  std::size_t outwards = 0;
  for (std::size_t i = 0; i < body.triangles.size(); i += 3) {
    const auto& a = body.positions_m[body.triangles[i]];
    const auto& b = body.positions_m[body.triangles[i + 1]];
    const auto& c = body.positions_m[body.triangles[i + 2]];
    const Eigen::Vector3f n = (b - a).cross(c - a);
    // Triangles at the poles of the capsules have no area and no side.
    if (n.norm() < 1e-9F || n.dot(body.normals[body.triangles[i]]) > 0) ++outwards;
  }
  EXPECT_EQ(outwards, body.triangles.size() / 3);
}

}  // namespace
}  // namespace counterpart
