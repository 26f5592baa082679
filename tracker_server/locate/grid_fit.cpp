#include "tracker_server/locate/grid_fit.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "tracker_server/edges/edge_search.hpp"
#include "tracker_server/locate/lattice.hpp"
#include "tracker_server/pose/normal_equations.hpp"

namespace counterpart {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

struct GridPoint {
  Vector2d m;        // in squares
  Vector2d along;    // direction of its line
  int polarity = 0;  // +1: brighter to the right of `along` in the picture
};

std::vector<GridPoint> inner_grid_points(int n, bool first_light) {
  std::vector<GridPoint> points;
  for (int line = 1; line < n; ++line)
    for (int cell = 0; cell < n; ++cell)
      for (double place : {0.12, 0.22, 0.5, 0.78, 0.88}) {
        // The square after the line, (line, cell) or (cell, line), is light if its colour is the first one's.
        const bool after_light = ((line + cell) % 2 == 0) == first_light;
        // Walking down in v, the square after lies on the left; walking right in u, on the right.
        points.push_back({Vector2d(line, cell + place), Vector2d(0, 1), after_light ? -1 : 1});
        points.push_back({Vector2d(cell + place, line), Vector2d(1, 0), after_light ? 1 : -1});
      }
  return points;
}

struct Round {
  double reach_in_squares;
  double least_reach_px;
};

}  // namespace

GridFit fit_grid(const Pyramid& pyramid, const Matrix3d& start, int n, bool first_light) {
  const auto points = inner_grid_points(n, first_light);
  // Conditioned unknowns: the board measures -1..1, pixels are divided by its size in the picture.
  Matrix3d from_unit;
  from_unit << 0.5 * n, 0, 0.5 * n, 0, 0.5 * n, 0.5 * n, 0, 0, 1;
  const Vector2d centre = apply(start, 0.5 * n, 0.5 * n);
  const double size = (apply(start, n, n) - apply(start, 0, 0)).norm();
  Matrix3d to_unit;
  to_unit << 1 / size, 0, -centre.x() / size, 0, 1 / size, -centre.y() / size, 0, 0, 1;
  const Matrix3d to_board = from_unit.inverse(), to_pixels = to_unit.inverse();

  GridFit result;
  result.H = start;
  Matrix3d G = to_unit * start * from_unit;
  G /= G(2, 2);
  std::vector<EdgeProbe> probes(points.size());
  std::vector<EdgeHit> hits(points.size());
  for (const Round& round : {Round{0.3, 4}, Round{0.15, 3}, Round{0.08, 2.5}, Round{0.06, 2.5}}) {
    const Matrix3d H = to_pixels * G * to_board;
    const double square = size / n / 1.5;
    const double reach = std::max(round.least_reach_px, round.reach_in_squares * square);
    // Wide searches run on a coarser picture: fewer looks, less noise.
    int level = 0;
    while (reach / (1 << level) > 10 && level + 1 < static_cast<int>(pyramid.levels.size())) ++level;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vector2d p = apply(H, points[i].m.x(), points[i].m.y());
      const Vector2d q =
          apply(H, points[i].m.x() + 0.05 * points[i].along.x(), points[i].m.y() + 0.05 * points[i].along.y());
      const Vector2d t = (q - p).normalized();
      probes[i] = {Pyramid::to_level(static_cast<float>(p.x()), level),
                   Pyramid::to_level(static_cast<float>(p.y()), level), static_cast<float>(-t.y()),
                   static_cast<float>(t.x()), static_cast<std::int8_t>(points[i].polarity)};
    }
    const EdgeSearch search{static_cast<float>(reach / (1 << level)), 8};
    search_edges(pyramid.levels[static_cast<std::size_t>(level)], probes, search, hits);

    const double tukey = std::max(1.5, 0.6 * reach);
    for (int iteration = 0; iteration < 4; ++iteration) {
      Eigen::Matrix<double, 8, 8> A = Eigen::Matrix<double, 8, 8>::Zero();
      Eigen::Matrix<double, 8, 1> b = Eigen::Matrix<double, 8, 1>::Zero();
      double squares = 0, weights = 0;
      int used = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (hits[i].verdict != EdgeVerdict::accepted) continue;
        const Eigen::Vector3d m = to_board * points[i].m.homogeneous();
        const Eigen::Vector3d h = G * m;
        const double x = h.x() / h.z(), y = h.y() / h.z();
        const double nx = probes[i].nx, ny = probes[i].ny;
        const Vector2d pixel = (to_pixels * h).hnormalized();
        const Vector2d first(probes[i].x, probes[i].y);
        const double scale = 1 << level;
        const Vector2d origin = ((first.array() + 0.5) * scale - 0.5).matrix();
        const double residual = hits[i].distance * scale - (pixel - origin).dot(Vector2d(nx, ny));
        const double ratio = residual / tukey;
        if (std::abs(ratio) >= 1) continue;
        const double weight = (1 - ratio * ratio) * (1 - ratio * ratio);
        Eigen::Matrix<double, 8, 1> J;
        J << nx * m, ny * m, -(nx * x + ny * y) * m.head<2>();
        J *= size / h.z();
        A += weight * J * J.transpose();
        b += weight * residual * J;
        squares += weight * residual * residual;
        weights += weight;
        ++used;
      }
      if (used < 20) return result;
      A.diagonal().array() += 1e-9 * A.trace();
      const Eigen::Matrix<double, 8, 1> step = solve_normal(A, b);
      if (!step.allFinite()) return result;
      G.row(0) += step.segment<3>(0).transpose();
      G.row(1) += step.segment<3>(3).transpose();
      G(2, 0) += step(6);
      G(2, 1) += step(7);
      result.rms_px = std::sqrt(squares / weights);
      result.share = static_cast<double>(used) / static_cast<double>(points.size());
    }
  }
  result.H = to_pixels * G * to_board;
  return result;
}

}  // namespace counterpart
