#include "vhd_renderer/draw/view.hpp"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace counterpart {
namespace {

View bent_view() {
  View view;
  view.intrinsics = {1, 720, 576, 640, 645, 355, 290, {-0.25, 0.08, 0.001, -0.0015, 0.02}};
  view.X_CB = look_at_X_CB({0.2, 0.8, 0.7}, {0, -0.2, 0.1});
  return view;
}

TEST(View, ProjectsAsOpenCvDoes) {
  const View view = bent_view();
  const Eigen::Matrix3d R = view.X_CB.linear();
  const Eigen::Vector3d t = view.X_CB.translation();
  const cv::Matx33d rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2));
  cv::Vec3d rvec;
  cv::Rodrigues(rotation, rvec);
  const auto& k = view.intrinsics;
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0.2, 0.2, 0), {-0.2, -0.2, 0}, {0.2, -0.2, 0.01}, {-0.1, 0.2, 0.2}}) {
    std::vector<cv::Point2d> expected;
    cv::projectPoints(std::vector<cv::Point3d>{{p.x(), p.y(), p.z()}}, rvec, cv::Vec3d(t.x(), t.y(), t.z()),
                      cv::Matx33d(k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1),
                      std::vector<double>(k.dist.begin(), k.dist.end()), expected);
    const Eigen::Vector2d found = project(view, p);
    EXPECT_NEAR(found.x(), expected[0].x, 1e-6);
    EXPECT_NEAR(found.y(), expected[0].y, 1e-6);
  }
}

TEST(View, LooksAtItsTargetWithUpUpwards) {
  View view = bent_view();
  view.intrinsics.dist = {};
  const Eigen::Vector2d centre = project(view, {0, -0.2, 0.1});
  EXPECT_NEAR(centre.x(), view.intrinsics.cx, 1e-9);
  EXPECT_NEAR(centre.y(), view.intrinsics.cy, 1e-9);
  EXPECT_LT(project(view, {0, -0.2, 0.2}).y(), centre.y());
  EXPECT_LT((camera_position_B(view) - Eigen::Vector3d(0.2, 0.8, 0.7)).norm(), 1e-12);
}

TEST(View, DistortionIsUsableUpToWhereItFolds) {
  EXPECT_GE(usable_radius_squared({}), 8.9);
  const double r2 = usable_radius_squared({-0.3, 0, 0, 0, 0});
  EXPECT_GT(r2, 1.0);
  EXPECT_LT(r2, 1 / 0.9);  // slope 1 - 0.9 r2
}

}  // namespace
}  // namespace counterpart
