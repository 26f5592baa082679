// A square lattice seen in perspective, grown from neighbouring saddles.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tracker_server/locate/saddles.hpp"

namespace counterpart {

struct LatticePoint {
  int u = 0, v = 0;  // lattice coordinates
  std::size_t saddle = 0;
};

struct Lattice {
  Eigen::Matrix3d H;  // lattice (u, v, 1) to pixels, u turns towards v as x towards y in the picture
  std::vector<LatticePoint> points;
};

// The lattices with most points first; each saddle belongs to one of them at most. Empty if fewer than min_points meet.
std::vector<Lattice> grow_lattices(const std::vector<Saddle>& saddles, std::size_t min_points,
                                   std::size_t max_lattices);

// Least squares homography, `from` to `to`, at least four points. Coordinates are conditioned inside.
Eigen::Matrix3d fit_homography(const std::vector<Eigen::Vector2d>& from, const std::vector<Eigen::Vector2d>& to);

inline Eigen::Vector2d apply(const Eigen::Matrix3d& H, double u, double v) {
  return (H * Eigen::Vector3d(u, v, 1)).hnormalized();
}

}  // namespace counterpart
