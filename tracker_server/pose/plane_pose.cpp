#include "tracker_server/pose/plane_pose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "tracker_server/pose/fit.hpp"
#include "tracker_server/pose/normal_equations.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

struct Crossing {
  Vector3d p_B;
  Vector2d pixel;
};

std::vector<Crossing> crossings(const Matrix3d& H, const BoardGeometry& board) {
  std::vector<Crossing> points;
  const int n = board.squares;
  const double D = board.square_size_m, half = 0.5 * n * D;
  for (int v = 0; v <= n; v += 2)
    for (int u = 0; u <= n; u += 2)
      points.push_back({{u * D - half, half - v * D, 0}, (H * Vector3d(u, v, 1)).hnormalized()});
  return points;
}

// From the columns of the homography between the plane and normalised coordinates.
Isometry3d decompose(const std::vector<Crossing>& points, const Intrinsics& camera) {
  // Four corners fix the homography of the undistorted plane well enough to start from.
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  double size = 1e-9;
  for (const auto& p : points) size = std::max(size, p.p_B.norm());
  for (const auto& p : points) {
    const Vector2d q = normalised_of_pixel(camera, p.pixel);
    const Vector3d m(p.p_B.x() / size, p.p_B.y() / size, 1);
    Eigen::Matrix<double, 9, 1> a, b;
    a << m, 0, 0, 0, -q.x() * m;
    b << 0, 0, 0, m, -q.y() * m;
    normal += a * a.transpose() + b * b.transpose();
  }
  const Eigen::Matrix<double, 9, 1> h = weakest_direction(normal);
  Matrix3d G;
  G << h(0) / size, h(1) / size, h(2), h(3) / size, h(4) / size, h(5), h(6) / size, h(7) / size, h(8);
  G /= 0.5 * (G.col(0).norm() + G.col(1).norm());
  if (G(2, 2) < 0) G = -G;
  // The two axes turned apart or together by the same angle until they are at right angles.
  const Vector3d along = (G.col(0).normalized() + G.col(1).normalized()).normalized();
  const Vector3d across = (G.col(0).normalized() - G.col(1).normalized()).normalized();
  Isometry3d X = Isometry3d::Identity();
  X.linear().col(0) = std::sqrt(0.5) * (along + across);
  X.linear().col(1) = std::sqrt(0.5) * (along - across);
  X.linear().col(2) = X.linear().col(0).cross(X.linear().col(1));
  X.translation() = G.col(2);
  return X;
}

double refine(const std::vector<Crossing>& points, const Intrinsics& camera, Isometry3d& X) {
  double rms = std::numeric_limits<double>::max();
  for (int round = 0; round < 15; ++round) {
    Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
    double squares = 0;
    for (const auto& point : points) {
      const Vector3d r_C = X.linear() * point.p_B;
      const Vector3d p = r_C + X.translation();
      if (!(p.z() > 1e-6)) return std::numeric_limits<double>::max();
      const Vector2d residual = point.pixel - project(camera, p);
      squares += residual.squaredNorm();
      Eigen::Matrix<double, 2, 3> g;
      g << camera.fx / p.z(), 0, -camera.fx * p.x() / (p.z() * p.z()), 0, camera.fy / p.z(),
          -camera.fy * p.y() / (p.z() * p.z());
      Eigen::Matrix<double, 2, 6> J;
      J.leftCols<3>() = g;
      for (int row = 0; row < 2; ++row) J.block<1, 3>(row, 3) = r_C.cross(Vector3d(g.row(row))).transpose();
      A += J.transpose() * J;
      b += J.transpose() * residual;
    }
    rms = std::sqrt(squares / static_cast<double>(points.size()));
    A.diagonal() *= 1 + 1e-9;
    const Eigen::Matrix<double, 6, 1> step = solve_normal(A, b);
    if (!step.allFinite()) return std::numeric_limits<double>::max();
    X = moved(X, step.head<3>(), step.tail<3>());
    if (step.norm() < 1e-10) break;
  }
  return rms;
}

PlanePose pose_from(const std::vector<Crossing>& points, const Intrinsics& camera) {
  PlanePose pose{decompose(points, camera), camera, 0};
  pose.rms_px = refine(points, camera, pose.X_CB);
  return pose;
}

}  // namespace

PlanePose pose_of_board(const Matrix3d& H, const BoardGeometry& board, const Intrinsics& camera) {
  return pose_from(crossings(H, board), camera);
}

PlanePose pose_and_focal_of_board(const Matrix3d& H, const BoardGeometry& board, int width, int height) {
  // Phones, webcams and film cameras mostly lie within a third of this.
  const double longest = std::max(width, height);
  const double usual_log = std::log(0.95 * longest);
  constexpr double usual_spread = 0.35;
  constexpr double crossing_sigma_px = 0.7;  // a homography from a real, not quite flat board
  const auto points = crossings(H, board);

  const auto cost = [&](double log_focal, PlanePose& pose) {
    pose = pose_from(points, centred_camera(width, height, std::exp(log_focal)));
    const double misfit = pose.rms_px / crossing_sigma_px * std::sqrt(8.0);
    const double unusual = (log_focal - usual_log) / usual_spread;
    return misfit * misfit + unusual * unusual;
  };
  PlanePose best, pose;
  double least = std::numeric_limits<double>::max(), best_log = usual_log;
  for (double step : {0.1, 0.02, 0.004}) {
    const double middle = best_log;
    const int reach = step == 0.1 ? 15 : 5;
    for (int i = -reach; i <= reach; ++i) {
      const double log_focal = middle + i * step;
      const double value = cost(log_focal, pose);
      if (value < least) {
        least = value;
        best = pose;
        best_log = log_focal;
      }
    }
  }
  return best;
}

Isometry3d pose_through_camera(const Isometry3d& X_CB, const Intrinsics& camera, const Intrinsics& other,
                               const BoardGeometry& board) {
  const double half = 0.5 * board.squares * board.square_size_m;
  std::vector<Crossing> points;
  for (double y : {-half, 0.0, half})
    for (double x : {-half, 0.0, half}) {
      const Vector3d p_B(x, y, 0);
      points.push_back({p_B, project(camera, X_CB * p_B)});
    }
  Isometry3d result = X_CB;
  result.translation().z() *= other.fx / camera.fx;
  refine(points, other, result);
  return result;
}

}  // namespace counterpart
