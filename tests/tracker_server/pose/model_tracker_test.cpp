#include "tracker_server/pose/model_tracker.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tracker_server/edges/pyramid.hpp"
#include "tracker_server/pose/model.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double half_m = 0.05;
constexpr std::int64_t frame_ns = 40'000'000;

struct Face {
  std::array<int, 4> corner;  // outward, counter-clockwise
  int grey;
};

const std::array<Vector3d, 8> corners = {Vector3d(-half_m, -half_m, -half_m), Vector3d(half_m, -half_m, -half_m),
                                         Vector3d(half_m, half_m, -half_m),   Vector3d(-half_m, half_m, -half_m),
                                         Vector3d(-half_m, -half_m, half_m),  Vector3d(half_m, -half_m, half_m),
                                         Vector3d(half_m, half_m, half_m),    Vector3d(-half_m, half_m, half_m)};
const std::array<Face, 6> faces = {{{{0, 3, 2, 1}, 60},
                                    {{4, 5, 6, 7}, 190},
                                    {{0, 1, 5, 4}, 120},
                                    {{1, 2, 6, 5}, 150},
                                    {{2, 3, 7, 6}, 95},
                                    {{3, 0, 4, 7}, 165}}};

std::string cube_obj() {
  std::string text;
  for (const Vector3d& p : corners)
    text += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  for (const Face& face : faces) {
    text += "f";
    for (const int c : face.corner) text += " " + std::to_string(c + 1);
    text += "\n";
  }
  return text;
}

// Painted four times as large and made smaller, so that edges are right to a few hundredths of a pixel. Stripes on
// every face are edges that the model does not have.
cv::Mat paint(const Intrinsics& camera, const Isometry3d& X_CM) {
  constexpr int times = 4;
  cv::Mat3b large(camera.height * times, camera.width * times, cv::Vec3b(215, 215, 215));
  const auto on_large = [&](const Vector3d& p_M) {
    const Eigen::Vector2d p = project(camera, X_CM * p_M);
    return cv::Point(static_cast<int>(std::lround(16 * ((p.x() + 0.5) * times - 0.5))),
                     static_cast<int>(std::lround(16 * ((p.y() + 0.5) * times - 0.5))));
  };
  const auto fill = [&](const std::vector<Vector3d>& polygon_M, int grey) {
    std::vector<cv::Point> polygon;
    for (const Vector3d& p : polygon_M) polygon.push_back(on_large(p));
    cv::fillConvexPoly(large, polygon, cv::Scalar::all(grey), cv::LINE_AA, 4);
  };
  for (const Face& face : faces) {
    const Vector3d a = corners[static_cast<std::size_t>(face.corner[0])];
    const Vector3d along = corners[static_cast<std::size_t>(face.corner[1])] - a;
    const Vector3d across = corners[static_cast<std::size_t>(face.corner[3])] - a;
    const Vector3d normal_C = X_CM.linear() * along.cross(across);
    if (normal_C.dot(X_CM * a) >= 0) continue;
    fill({a, a + along, a + along + across, a + across}, face.grey);
    for (const double at : {0.3, 0.6}) {
      const Vector3d b = a + at * along + 0.15 * across;
      fill({b, b + 0.12 * along, b + 0.12 * along + 0.7 * across, b + 0.7 * across}, face.grey > 110 ? 40 : 210);
    }
  }
  cv::Mat picture;
  cv::resize(large, picture, {camera.width, camera.height}, 0, 0, cv::INTER_AREA);
  return picture;
}

TEST(ModelTracker, FollowsAStripedCubeThatTurns) {
  Intrinsics camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 700;
  camera.cx = 319.5;
  camera.cy = 239.5;
  const auto path = std::filesystem::temp_directory_path() / "counterpart_striped_cube.obj";
  std::ofstream(path) << cube_obj();
  const auto model = read_obj_model(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(model) << model.error().message;
  ModelTracker tracker(*model, camera, Predictor::first, {});
  for (int frame = 0; frame < 60; ++frame) {
    Isometry3d X_CM = Isometry3d::Identity();
    X_CM.linear() =
        (Eigen::AngleAxisd(0.9, Vector3d::UnitX()) * Eigen::AngleAxisd(0.4 + 0.012 * frame, Vector3d::UnitZ()))
            .toRotationMatrix();
    X_CM.translation() = Vector3d(0.03 * std::sin(0.1 * frame), 0.01, 0.55);
    if (frame == 0) tracker.start_at(X_CM);
    const TrackedModel seen = tracker.track(build_pyramid(paint(camera, X_CM), 3), frame * frame_ns);
    ASSERT_EQ(seen.status, TrackStatus::ok) << frame;
    // Stripes lie a few pixels inside the outlines; a pose that takes them for outlines is off by that much.
    for (const Vector3d& p : corners)
      EXPECT_LT((project(camera, seen.X_CM * p) - project(camera, X_CM * p)).norm(), 1.0) << frame;
  }
}

}  // namespace
}  // namespace counterpart
