#include "vhd_renderer/draw/renderer.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace counterpart {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

View plain_view() {
  View view;
  view.intrinsics = {1, kWidth, kHeight, 300, 300, 159.5, 119.5, {}};
  view.X_CB = look_at_X_CB({0.1, 0.9, 0.8}, {0, 0, 0});
  return view;
}

class RendererTest : public testing::Test {
 protected:
  void SetUp() override {
    auto made = Renderer::create(kWidth, kHeight, 512);
    ASSERT_TRUE(made.has_value()) << made.error().message;
    renderer = std::move(*made);
  }
  MeshId add(const MeshData& mesh) { return renderer->add_mesh(mesh).value(); }
  static DrawItem item(MeshId mesh, SurfaceId surface, const Eigen::Vector3f& at = {0, 0, 0}) {
    DrawItem result;
    result.mesh = mesh;
    result.material.surface = surface;
    result.X_BO = {Eigen::Affine3f(Eigen::Translation3f(at))};
    return result;
  }
  static cv::Vec4b pixel(const Drawing& drawing, const View& view, const Eigen::Vector3d& p_B) {
    const Eigen::Vector2d at = project(view, p_B);
    return drawing.bgra.at<cv::Vec4b>(static_cast<int>(std::lround(at.y())), static_cast<int>(std::lround(at.x())));
  }
  std::unique_ptr<Renderer> renderer;
};

// A square plate far from black: the mean place of its pixels must be where its mean projects, and its edges must end
// where its corners project (pixels are inside or outside, so half a pixel at most).
void expect_plate_where_projected(Renderer& renderer, MeshId plate, const View& view, double half_m) {
  DrawItem item;
  item.mesh = plate;
  item.material.surface = SurfaceId::unlit;
  const Drawing drawing = renderer.draw(view, {}, std::vector<DrawItem>{item});
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
  constexpr int kSteps = 200;
  for (int i = 0; i <= kSteps; ++i) {
    const double s = half_m * (2.0 * i / kSteps - 1);
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(s, half_m, 0), {s, -half_m, 0}, {half_m, s, 0}, {-half_m, s, 0}}) {
      const Eigen::Vector2d at = project(view, p);
      left = std::min(left, at.x());
      right = std::max(right, at.x());
      top = std::min(top, at.y());
      bottom = std::max(bottom, at.y());
    }
  }
  int x0 = kWidth, x1 = -1, y0 = kHeight, y1 = -1;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (drawing.bgra.at<cv::Vec4b>(y, x)[3] == 0) continue;
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
      y0 = std::min(y0, y);
      y1 = std::max(y1, y);
    }
  }
  EXPECT_NEAR(x0, left + 0.5, 0.6);
  EXPECT_NEAR(x1, right - 0.5, 0.6);
  EXPECT_NEAR(y0, top + 0.5, 0.6);
  EXPECT_NEAR(y1, bottom - 0.5, 0.6);
}

TEST_F(RendererTest, DrawsWhereTheViewProjects) {
  const MeshId plate = add(plane_mesh(0.4f, 0.4f, 20, 20));
  View view = plain_view();
  expect_plate_where_projected(*renderer, plate, view, 0.2);
  view.intrinsics.dist = {-0.3, 0.1, 0.002, -0.003, 0.0};
  expect_plate_where_projected(*renderer, plate, view, 0.2);
}

TEST_F(RendererTest, NearerThingsHideFartherOnes) {
  const MeshId box = add(box_mesh({0.1f, 0.1f, 0.1f}));
  const View view = plain_view();
  DrawItem red = item(box, SurfaceId::unlit, {0, 0, 0});
  red.material.colour = {1, 0, 0};
  const DrawItem front = item(box, SurfaceId::unlit, {0.02f, 0.15f, 0.15f});
  const Drawing drawing = renderer->draw(view, {}, std::vector<DrawItem>{front, red});
  EXPECT_GT(pixel(drawing, view, {0.02, 0.2, 0.2})[0], 200);  // white box in front, though drawn first
}

TEST_F(RendererTest, CatcherHidesAndIsBlackAndDarkensUnderAThing) {
  const MeshId table = add(plane_mesh(1, 1, 4, 4));
  const MeshId wall = add(box_mesh({0.6f, 0.02f, 0.4f}));
  const MeshId ball = add(box_mesh({0.1f, 0.1f, 0.1f}));
  const View view = plain_view();
  Lighting light;
  light.direction_B = {0, 0, 1};
  const DrawItem floor = item(table, SurfaceId::catcher, {0, 0, -0.1f});
  DrawItem occluder = item(wall, SurfaceId::catcher, {0, 0.3f, 0.1f});
  occluder.casts_shadow = false;
  const DrawItem thing = item(ball, SurfaceId::lit, {0, 0, 0.1f});

  Drawing open = renderer->draw(view, light, std::vector<DrawItem>{floor, thing});
  EXPECT_EQ(pixel(open, view, {0, 0.05, 0.1})[3], 255);
  EXPECT_GT(pixel(open, view, {0, 0.05, 0.1})[1], 0);
  const cv::Vec4b under = pixel(open, view, {0, 0.04, -0.1});  // vertical light: the shadow is right below
  EXPECT_EQ(under[0] | under[1] | under[2], 0);
  EXPECT_GT(under[3], 60);
  EXPECT_EQ(pixel(open, view, {0.3, 0.2, -0.1})[3], 0);  // in the light: untouched

  Drawing hidden = renderer->draw(view, light, std::vector<DrawItem>{floor, occluder, thing});
  const cv::Vec4b behind = pixel(hidden, view, {0, 0.05, 0.1});
  EXPECT_EQ(behind[0] | behind[1] | behind[2], 0);
}

// Whatever changes what a shadow comes from changes the shadow: its place, its light, its vertices, whether it casts
// one.
TEST_F(RendererTest, ShadowsFollowWhatCastsThem) {
  const MeshId table = add(plane_mesh(1, 1, 4, 4));
  const MeshData cube = box_mesh({0.1f, 0.1f, 0.1f});
  const MeshId ball = add(cube);
  const View view = plain_view();
  Lighting light;
  light.direction_B = {0, 0, 1};
  const DrawItem floor = item(table, SurfaceId::catcher, {0, 0, -0.1f});
  const auto is_dark = [&](const DrawItem& thing, const Eigen::Vector3d& p_B) {
    const Drawing drawing = renderer->draw(view, light, std::vector<DrawItem>{floor, thing});
    return pixel(drawing, view, p_B)[3] > 60;
  };
  DrawItem thing = item(ball, SurfaceId::lit, {0, 0, 0.1f});
  thing.visible = false;
  const Eigen::Vector3d below(0, 0, -0.1), aside(0.2, 0, -0.1);
  EXPECT_TRUE(is_dark(thing, below));
  EXPECT_FALSE(is_dark(thing, aside));
  thing.X_BO[0].translation().x() = 0.2f;
  EXPECT_FALSE(is_dark(thing, below));
  EXPECT_TRUE(is_dark(thing, aside));

  std::vector<Eigen::Vector3f> moved = cube.positions_m;
  for (Eigen::Vector3f& p : moved) p.x() -= 0.2f;
  renderer->update_mesh(ball, moved, cube.normals);
  EXPECT_TRUE(is_dark(thing, below));
  EXPECT_FALSE(is_dark(thing, aside));

  light.direction_B = {1, 0, 1};  // 0.2 m above the table: the shadow falls 0.2 m aside
  EXPECT_FALSE(is_dark(thing, below));
  EXPECT_TRUE(is_dark(thing, {-0.2, 0, -0.1}));
  thing.casts_shadow = false;
  EXPECT_FALSE(is_dark(thing, {-0.2, 0, -0.1}));
}

TEST_F(RendererTest, GivesDepthInMetres) {
  const MeshId plate = add(plane_mesh(0.4f, 0.4f, 4, 4));
  const View view = plain_view();
  DrawOptions options;
  options.depth = true;
  const Drawing drawing = renderer->draw(view, {}, std::vector<DrawItem>{item(plate, SurfaceId::lit)}, options);
  const double expected = (view.X_CB * Eigen::Vector3d::Zero()).z();
  EXPECT_NEAR(drawing.depth_m.at<float>(120, 160), expected, 0.005);
  EXPECT_TRUE(std::isinf(drawing.depth_m.at<float>(0, 0)));
}

TEST_F(RendererTest, TwiceTheSameIsTheSame) {
  const MeshId box = add(box_mesh({0.2f, 0.2f, 0.1f}));
  const std::vector<DrawItem> items{item(box, SurfaceId::lit)};
  const Drawing a = renderer->draw(plain_view(), {}, items);
  const Drawing b = renderer->draw(plain_view(), {}, items);
  EXPECT_EQ(cv::norm(a.bgra, b.bgra, cv::NORM_L1), 0);
}

TEST_F(RendererTest, RefusesBrokenMeshesAndSizes) {
  MeshData mesh = box_mesh({1, 1, 1});
  mesh.triangles.push_back(999);
  mesh.triangles.push_back(0);
  mesh.triangles.push_back(1);
  EXPECT_EQ(renderer->add_mesh(mesh).error().code, ErrorCode::invalid_argument);
  EXPECT_EQ(Renderer::create(0, 10).error().code, ErrorCode::invalid_argument);
}

TEST_F(RendererTest, BrokenSurfacesSayWhatTheCompilerSaid) {
  const auto surface = renderer->add_surface("vec3 surface_colour(vec2 uv, vec3 p, vec3 c) { return nonsense; }");
  ASSERT_FALSE(surface.has_value());
  EXPECT_NE(surface.error().message.find("nonsense"), std::string::npos);
}

}  // namespace
}  // namespace counterpart
