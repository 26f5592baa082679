#include "tests/tracker_server/support/cube_picture.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <unistd.h>

#include "tracker_server/pose/projection.hpp"

namespace counterpart::test {
namespace {

using Eigen::Vector3d;

struct PaintedFace {
  std::array<int, 4> corner;  // outward, counter-clockwise
  int grey;
};

const std::array<PaintedFace, 6> painted_faces = {{{{0, 3, 2, 1}, 60},
                                                   {{4, 5, 6, 7}, 190},
                                                   {{0, 1, 5, 4}, 120},
                                                   {{1, 2, 6, 5}, 150},
                                                   {{2, 3, 7, 6}, 95},
                                                   {{3, 0, 4, 7}, 165}}};

}  // namespace

const std::array<Vector3d, 8>& cube_corners() {
  constexpr double h = cube_half_m;
  static const std::array<Vector3d, 8> corners = {Vector3d(-h, -h, -h), Vector3d(h, -h, -h), Vector3d(h, h, -h),
                                                  Vector3d(-h, h, -h),  Vector3d(-h, -h, h), Vector3d(h, -h, h),
                                                  Vector3d(h, h, h),    Vector3d(-h, h, h)};
  return corners;
}

std::string cube_obj() {
  std::string text;
  for (const Vector3d& p : cube_corners())
    text += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
  for (const PaintedFace& face : painted_faces) {
    text += "f";
    for (const int c : face.corner) text += " " + std::to_string(c + 1);
    text += "\n";
  }
  return text;
}

Model cube_model() {
  const auto path = std::filesystem::temp_directory_path() / ("counterpart_cube_" + std::to_string(getpid()) + ".obj");
  std::ofstream(path) << cube_obj();
  auto model = read_obj_model(path);
  std::filesystem::remove(path);
  if (!model) throw std::runtime_error(model.error().message);
  return *std::move(model);
}

void paint_cube(const Intrinsics& camera, const Eigen::Isometry3d& X_CM, cv::Mat& picture) {
  constexpr int times = 4;
  cv::Mat large;
  cv::resize(picture, large, {}, times, times, cv::INTER_NEAREST);
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
  const auto& corners = cube_corners();
  for (const PaintedFace& face : painted_faces) {
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
  cv::resize(large, picture, {camera.width, camera.height}, 0, 0, cv::INTER_AREA);
}

Intrinsics camera_640x480() {
  Intrinsics camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 700;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

double farthest_cube_corner_px(const Intrinsics& camera, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  double farthest = 0;
  for (const Vector3d& p : cube_corners()) {
    const double px = (project(camera, a * p) - project(camera, b * p)).norm();
    farthest = std::isfinite(px) ? std::max(farthest, px) : 1e9;
  }
  return farthest;
}

}  // namespace counterpart::test
