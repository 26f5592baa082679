#include "vhd_renderer/scene/virtual_scene.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "vhd_renderer/draw/mesh.hpp"

namespace counterpart {
namespace {

// A person of two boxes, seated across the board at -y: trunk from below the table top upwards, and a head.
Figure box_person() {
  Figure figure;
  figure.name = "box person";
  for (const auto& [size, at] : {std::pair{Eigen::Vector3f(0.4f, 0.25f, 0.9f), Eigen::Vector3f(0, -0.66f, -0.1f)},
                                 {Eigen::Vector3f(0.18f, 0.2f, 0.22f), Eigen::Vector3f(0, -0.66f, 0.5f)}}) {
    MeshData mesh;
    append(mesh, box_mesh(size), at);
    FigurePart part;
    part.name = "box";
    part.positions_m = mesh.positions_m;
    part.normals = mesh.normals;
    part.uvs = mesh.uvs;
    part.triangles = mesh.triangles;
    part.colour = {0.3f, 0.4f, 0.7f};
    figure.parts.push_back(part);
  }
  return figure;
}

std::vector<SkinnedPart> as_bound(const Figure& figure) {
  std::vector<SkinnedPart> parts;
  for (const FigurePart& part : figure.parts) parts.push_back({part.positions_m, part.normals});
  return parts;
}

View view_from_player() {
  View view;
  view.intrinsics = {1, 360, 288, 305, 305, 179.5, 143.5, {}};
  view.X_CB = look_at_X_CB({0.1, 0.74, 0.62}, {0, -0.2, 0.1});
  return view;
}

StagedPiece staged(double x, double y) {
  StagedPiece piece;
  piece.name = "light_31";
  piece.X_BP.translation() = Eigen::Vector3d(x, y, 0).cast<float>();
  return piece;
}

class VirtualSceneTest : public testing::Test {
 protected:
  void SetUp() override {
    auto made = VirtualScene::create(360, 288, figure);
    ASSERT_TRUE(made.has_value()) << made.error().message;
    scene = std::move(*made);
  }
  RenderedFrame draw(const Scene& what, const std::vector<StagedPiece>& pieces, const std::vector<SkinnedPart>& parts) {
    return scene->draw(view, what, pieces, parts).value();
  }
  cv::Point pixel(const Eigen::Vector3d& p_B) const {
    const Eigen::Vector2d at = project(view, p_B);
    return {static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y()))};
  }
  Figure figure = box_person();
  View view = view_from_player();
  std::unique_ptr<VirtualScene> scene;
};

TEST_F(VirtualSceneTest, TheTableHidesThePersonBehindIt) {
  const RenderedFrame frame = draw({}, {}, as_bound(figure));
  EXPECT_EQ(frame.alpha.at<std::uint8_t>(pixel({0, -0.56, 0.5})), 255);  // the head is seen
  const cv::Point knee = pixel({0, -0.535, -0.3});                       // below the table top, behind its edge
  EXPECT_EQ(frame.alpha.at<std::uint8_t>(knee), 0);
  EXPECT_EQ(frame.bgr.at<cv::Vec3b>(knee), cv::Vec3b(0, 0, 0)) << "what hides is black, the paper's key colour";
}

TEST_F(VirtualSceneTest, ARealPieceHidesAVirtualOneBehindIt) {
  const std::vector<StagedPiece> virtual_piece{staged(0, 0)};
  const cv::Point foot = pixel({0, 0.0157, 0.001});  // low on its near side
  EXPECT_EQ(draw({}, virtual_piece, {}).alpha.at<std::uint8_t>(foot), 255);
  Scene with_real;
  ScenePiece real;
  real.real = true;
  real.king = true;
  // Right between the camera and that place, touching the other piece.
  const Eigen::Vector3d to_camera = camera_position_B(view).normalized();
  real.p_B = {0.034 * to_camera.x() / to_camera.head<2>().norm(), 0.034 * to_camera.y() / to_camera.head<2>().norm(),
              0};
  with_real.pieces = {real};
  EXPECT_EQ(draw(with_real, virtual_piece, {}).alpha.at<std::uint8_t>(foot), 0);
}

TEST_F(VirtualSceneTest, AVirtualPieceShadowsTheRealBoard) {
  Scene low_light;
  low_light.light.direction_B = {1, 0, 1};
  const RenderedFrame frame = draw(low_light, {staged(0, 0)}, {});
  EXPECT_LT(frame.shadow.at<std::uint8_t>(pixel({-0.019, 0, 0})), 200);  // away from the light
  EXPECT_EQ(frame.shadow.at<std::uint8_t>(pixel({0.025, 0, 0})), 255);   // towards it
}

TEST_F(VirtualSceneTest, TouchesOnlyTheBoxItNames) {
  const RenderedFrame frame = draw({}, {staged(0.1, 0.1)}, {});
  EXPECT_LT(frame.box.area(), 60 * 60);
  EXPECT_TRUE(frame.box.contains(pixel({0.1, 0.1, 0.004})));
  cv::Mat outside = frame.alpha.clone();
  outside(frame.box).setTo(0);
  EXPECT_EQ(cv::countNonZero(outside), 0);
}

TEST_F(VirtualSceneTest, NothingVirtualGivesAnEmptyBox) {
  EXPECT_TRUE(draw({}, {}, {}).box.empty());
}

TEST_F(VirtualSceneTest, RefusesAnotherPictureSizeAndPosesThatAreNotNumbers) {
  View other = view;
  other.intrinsics.width = 720;
  EXPECT_EQ(scene->draw(other, Scene{}, std::vector<StagedPiece>{}, std::vector<SkinnedPart>{}).error().code,
            ErrorCode::invalid_argument);
  View nan = view;
  nan.X_CB.translation().x() = std::nan("");
  EXPECT_EQ(scene->draw(nan, Scene{}, std::vector<StagedPiece>{}, std::vector<SkinnedPart>{}).error().code,
            ErrorCode::not_a_number);
}

}  // namespace
}  // namespace counterpart
