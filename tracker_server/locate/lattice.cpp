#include "tracker_server/locate/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <Eigen/LU>

#include "tracker_server/pose/normal_equations.hpp"

namespace counterpart {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr float pi = std::numbers::pi_v<float>;
constexpr float same_direction = 0.35F;  // radians
constexpr double same_place = 0.22;      // share of the distance to the next lattice point

float direction_difference(float a, float b) {
  const float d = std::fmod(std::abs(a - b), pi);
  return std::min(d, pi - d);
}

// Whether b can be the neighbour of a along one of its edges: light and dark exchanged.
bool alternates(const Saddle& a, const Saddle& b) {
  return direction_difference(a.edge[0], b.edge[1]) < same_direction &&
         direction_difference(a.edge[1], b.edge[0]) < same_direction;
}

bool same_phase(const Saddle& a, const Saddle& b) {
  return direction_difference(a.edge[0], b.edge[0]) < same_direction &&
         direction_difference(a.edge[1], b.edge[1]) < same_direction;
}

Vector2d point(const Saddle& saddle) {
  return {saddle.p.x, saddle.p.y};
}

// Nearest saddles by a coarse grid of buckets.
class Neighbourhood {
 public:
  explicit Neighbourhood(const std::vector<Saddle>& saddles) : saddles_(saddles) {
    for (std::size_t i = 0; i < saddles.size(); ++i) buckets_[key(point(saddles[i]))].push_back(i);
  }

  template <class Visit>
  void visit(const Vector2d& p, double radius, const Visit& visitor) const {
    const int reach = static_cast<int>(std::ceil(radius / bucket_px));
    const auto [column, row] = key(p);
    if (reach > 3) {
      for (std::size_t i = 0; i < saddles_.size(); ++i)
        if ((point(saddles_[i]) - p).norm() <= radius) visitor(i);
      return;
    }
    for (int y = row - reach; y <= row + reach; ++y)
      for (int x = column - reach; x <= column + reach; ++x) {
        const auto bucket = buckets_.find({x, y});
        if (bucket == buckets_.end()) continue;
        for (std::size_t i : bucket->second)
          if ((point(saddles_[i]) - p).norm() <= radius) visitor(i);
      }
  }

 private:
  static constexpr double bucket_px = 24;
  static std::pair<int, int> key(const Vector2d& p) {
    return {static_cast<int>(p.x() / bucket_px), static_cast<int>(p.y() / bucket_px)};
  }
  const std::vector<Saddle>& saddles_;
  std::map<std::pair<int, int>, std::vector<std::size_t>> buckets_;
};

// The nearest possible neighbours of a saddle along a direction, nearest first.
std::vector<std::size_t> neighbours_along(const std::vector<Saddle>& saddles, std::size_t from, float angle) {
  std::vector<std::pair<double, std::size_t>> found;
  const Vector2d along(std::cos(angle), std::sin(angle));
  for (std::size_t i = 0; i < saddles.size(); ++i) {
    if (i == from) continue;
    const Vector2d step = point(saddles[i]) - point(saddles[from]);
    const double distance = step.norm();
    if (distance < 8 || distance > 250) continue;
    if (step.dot(along) < 0.985 * distance) continue;
    if (alternates(saddles[from], saddles[i])) found.emplace_back(distance, i);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> nearest;
  for (std::size_t i = 0; i < std::min<std::size_t>(2, found.size()); ++i) nearest.push_back(found[i].second);
  return nearest;
}

std::size_t nearest_to(const Neighbourhood& space, const std::vector<Saddle>& saddles, const Vector2d& p, double radius,
                       const Saddle& like, bool alternate) {
  std::size_t best = saddles.size();
  double best_distance = radius;
  space.visit(p, radius, [&](std::size_t i) {
    const double distance = (point(saddles[i]) - p).norm();
    if (distance > best_distance) return;
    if (alternate ? !alternates(like, saddles[i]) : !same_phase(like, saddles[i])) return;
    best = i;
    best_distance = distance;
  });
  return best;
}

Matrix3d fit(const std::vector<Saddle>& saddles, const std::vector<LatticePoint>& points) {
  std::vector<Vector2d> from, to;
  for (const auto& p : points) {
    from.emplace_back(p.u, p.v);
    to.push_back(point(saddles[p.saddle]));
  }
  return fit_homography(from, to);
}

double spacing_at(const Matrix3d& H, int u, int v) {
  const Vector2d here = apply(H, u, v);
  return std::min((apply(H, u + 1, v) - here).norm(), (apply(H, u, v + 1) - here).norm());
}

// Grows from four corners of one square until no more saddle fits.
Lattice grow(const std::vector<Saddle>& saddles, const Neighbourhood& space, std::vector<LatticePoint> points) {
  constexpr int largest = 24;  // lattice points a side: more than any board's, with room for a pattern round it
  Lattice lattice;
  lattice.H = fit(saddles, points);
  for (int round = 0; round < largest; ++round) {
    std::map<std::pair<int, int>, std::size_t> taken;
    std::vector<char> used(saddles.size(), 0);
    for (const auto& p : points) {
      taken[{p.u, p.v}] = p.saddle;
      used[p.saddle] = 1;
    }
    const std::size_t before = points.size();
    std::vector<LatticePoint> added;
    for (const auto& p : points)
      for (const auto& [du, dv] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {2, 0}, {-2, 0}, {0, 2}, {0, -2}}) {
        const int u = p.u + du, v = p.v + dv;
        if (std::abs(u) > largest || std::abs(v) > largest || taken.contains({u, v})) continue;
        // Two squares at a stride only once the lattice is known well enough.
        if (std::abs(du) + std::abs(dv) == 2 && points.size() < 9) continue;
        const Eigen::Vector3d h = lattice.H * Eigen::Vector3d(u, v, 1);
        if (!(h.z() * (lattice.H * Eigen::Vector3d(p.u, p.v, 1)).z() > 0)) continue;
        const double spacing = spacing_at(lattice.H, u, v);
        if (!(spacing > 5 && spacing < 400)) continue;
        // The orientation is compared with the point grown from: it turns slowly over a picture in perspective.
        const bool alternate = (du + dv) % 2 != 0;
        const std::size_t hit =
            nearest_to(space, saddles, h.hnormalized(), same_place * spacing, saddles[p.saddle], alternate);
        if (hit == saddles.size() || used[hit]) continue;
        taken[{u, v}] = hit;
        used[hit] = 1;
        added.push_back({u, v, hit});
      }
    points.insert(points.end(), added.begin(), added.end());
    lattice.H = fit(saddles, points);
    // Points that do not fit what all the others say are given back.
    std::erase_if(points, [&](const LatticePoint& p) {
      return !((apply(lattice.H, p.u, p.v) - point(saddles[p.saddle])).norm() <
               same_place * spacing_at(lattice.H, p.u, p.v));
    });
    if (points.size() < 4) break;
    lattice.H = fit(saddles, points);
    if (points.size() <= before) break;
  }
  lattice.points = std::move(points);
  return lattice;
}

}  // namespace

Matrix3d fit_homography(const std::vector<Vector2d>& from, const std::vector<Vector2d>& to) {
  const auto conditioner = [](const std::vector<Vector2d>& points) {
    Vector2d mean = Vector2d::Zero();
    for (const auto& p : points) mean += p;
    mean /= static_cast<double>(points.size());
    double spread = 1e-9;
    for (const auto& p : points) spread += (p - mean).norm();
    const double scale = std::numbers::sqrt2 * static_cast<double>(points.size()) / spread;
    Matrix3d T;
    T << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
    return T;
  };
  const Matrix3d A = conditioner(from), B = conditioner(to);
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector3d p = A * from[i].homogeneous();
    const Vector2d q = (B * to[i].homogeneous()).hnormalized();
    Eigen::Matrix<double, 9, 1> a, b;
    a << p, 0, 0, 0, -q.x() * p;
    b << 0, 0, 0, p, -q.y() * p;
    normal += a * a.transpose() + b * b.transpose();
  }
  const Eigen::Matrix<double, 9, 1> h = weakest_direction(normal);
  Matrix3d H;
  H << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), h(8);
  H = (B.inverse() * H * A).eval();
  // Positive depth where the points are.
  const Eigen::Vector3d first = H * from.front().homogeneous();
  if (first.z() < 0) H = -H;
  return H / H.norm();
}

std::vector<Lattice> grow_lattices(const std::vector<Saddle>& saddles, std::size_t min_points,
                                   std::size_t max_lattices) {
  const Neighbourhood space(saddles);
  std::vector<Lattice> lattices;
  std::vector<char> used(saddles.size(), 0);
  for (std::size_t seed = 0; seed < saddles.size(); ++seed) {
    if (used[seed]) continue;
    const Saddle& s = saddles[seed];
    Lattice best;
    for (float turn0 : {0.0F, pi}) {
      for (std::size_t a : neighbours_along(saddles, seed, s.edge[0] + turn0)) {
        for (float turn1 : {0.0F, pi}) {
          for (std::size_t b : neighbours_along(saddles, seed, s.edge[1] + turn1)) {
            const Vector2d across = point(saddles[a]) + point(saddles[b]) - point(s);
            const double side = std::min((point(saddles[a]) - point(s)).norm(), (point(saddles[b]) - point(s)).norm());
            const std::size_t c = nearest_to(space, saddles, across, 0.35 * side, s, false);
            if (c == saddles.size() || c == seed || c == a || c == b) continue;
            const Vector2d u = point(saddles[a]) - point(s), v = point(saddles[b]) - point(s);
            const bool turns_right = u.x() * v.y() - u.y() * v.x() > 0;
            std::vector<LatticePoint> corners = {{0, 0, seed}, {1, 0, a}, {0, 1, b}, {1, 1, c}};
            if (!turns_right) corners = {{0, 0, seed}, {1, 0, b}, {0, 1, a}, {1, 1, c}};
            Lattice grown = grow(saddles, space, std::move(corners));
            if (grown.points.size() > best.points.size()) best = std::move(grown);
          }
          if (best.points.size() >= 4 * min_points) break;
        }
      }
    }
    if (best.points.size() < min_points) continue;
    for (const auto& p : best.points) used[p.saddle] = 1;
    lattices.push_back(std::move(best));
    if (lattices.size() == max_lattices) break;
  }
  std::sort(lattices.begin(), lattices.end(),
            [](const Lattice& a, const Lattice& b) { return a.points.size() > b.points.size(); });
  return lattices;
}

}  // namespace counterpart
