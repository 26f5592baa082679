#include "vhd_renderer/body/simplify.hpp"

#include <algorithm>
#include <cmath>

#include "tests/vhd_renderer/body/figure_check.hpp"
#include "vhd_renderer/body/mannequin.hpp"

namespace counterpart {
namespace {

std::size_t triangles(const Figure& figure) {
  std::size_t count = 0;
  for (const FigurePart& part : figure.parts) count += part.triangles.size() / 3;
  return count;
}

TEST(Simplify, GivesASoundFigureOfTheSameShapeWithFewerTriangles) {
  Figure whole = mannequin();
  whole.parts[0].morphs.push_back({"smile", {3, 7, 50}, {{0.01F, 0, 0}, {0, 0.01F, 0}, {0, 0, 0.01F}}});
  const Figure simple = simplified(whole, 0.003F);
  expect_sound(simple);
  EXPECT_LT(triangles(simple), triangles(whole) * 3 / 4);
  for (std::size_t p = 0; p < whole.parts.size(); ++p) {
    Eigen::AlignedBox3f before, after;
    for (const Eigen::Vector3f& at : whole.parts[p].positions_m) before.extend(at);
    for (const Eigen::Vector3f& at : simple.parts[p].positions_m) after.extend(at);
    EXPECT_LT((before.min() - after.min()).norm(), 0.012F) << whole.parts[p].name;
    EXPECT_LT((before.max() - after.max()).norm(), 0.012F) << whole.parts[p].name;
  }
}

TEST(Simplify, CoarserIsLessAndNoErrorIsNoChange) {
  const Figure whole = mannequin();
  EXPECT_LT(triangles(simplified(whole, 0.01F)), triangles(simplified(whole, 0.001F)));
  EXPECT_EQ(triangles(simplified(whole, 0)), triangles(whole));
}

}  // namespace
}  // namespace counterpart
