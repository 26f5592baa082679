#include "vhd_renderer/motion/walk_round.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace counterpart {
namespace {

using Eigen::Rotation2Df;
using Eigen::Vector2f;

// Distance of a segment from a rectangle; 0 where they meet.
float distance(const Vector2f& a, const Vector2f& b, const Footprint& f) {
  const Rotation2Df to_own(-f.turn_rad);
  const Vector2f p = to_own * (a - f.middle_S);
  const Vector2f d = to_own * (b - f.middle_S) - p;
  const auto at = [&](float t) {
    const Vector2f out = ((p + t * d).cwiseAbs() - f.half_m).cwiseMax(0.F);
    return out.norm();
  };
  // The distance from a convex body along a line has one valley.
  float low = 0;
  float high = 1;
  for (int round = 0; round < 40; ++round) {
    const float third = (high - low) / 3;
    (at(low + third) < at(high - third) ? high : low) = at(low + third) < at(high - third) ? high - third : low + third;
  }
  return std::min({at(0), at(1), at(0.5F * (low + high))});
}

bool clear(const Vector2f& a, const Vector2f& b, const std::vector<Footprint>& obstacles) {
  return std::all_of(obstacles.begin(), obstacles.end(), [&](const Footprint& f) {
    // Whoever stands near a thing may walk away from it, but not through it.
    const float ends = std::min(distance(a, a, f), distance(b, b, f));
    const float wanted = std::min(body_clearance_m, 0.95F * ends);
    return distance(a, b, f) >= wanted && ends > 0;
  });
}

// Corners round the obstacles, far enough out that the ways between them are clear.
std::vector<Vector2f> corners_of(const std::vector<Footprint>& obstacles) {
  std::vector<Vector2f> corners;
  for (const Footprint& f : obstacles) {
    for (const float x : {-1.F, 1.F}) {
      for (const float y : {-1.F, 1.F}) {
        const Vector2f out = (f.half_m.array() + body_clearance_m + 0.04F).matrix().cwiseProduct(Vector2f(x, y));
        const Vector2f corner = f.middle_S + Rotation2Df(f.turn_rad) * out;
        const bool free = std::all_of(obstacles.begin(), obstacles.end(), [&](const Footprint& other) {
          return distance(corner, corner, other) >= body_clearance_m;
        });
        if (free) corners.push_back(corner);
      }
    }
  }
  return corners;
}

}  // namespace

std::optional<std::vector<Vector2f>> way_round(const Vector2f& a, const Vector2f& b,
                                               const std::vector<Footprint>& obstacles) {
  if (clear(a, b, obstacles)) return std::vector<Vector2f>{};
  std::vector<Vector2f> nodes = corners_of(obstacles);
  nodes.push_back(a);
  nodes.push_back(b);
  const std::size_t start = nodes.size() - 2;
  const std::size_t goal = nodes.size() - 1;
  // Dijkstra over what sees each other.
  constexpr float far = std::numeric_limits<float>::infinity();
  std::vector<float> cost(nodes.size(), far);
  std::vector<std::size_t> before(nodes.size(), start);
  std::vector<bool> done(nodes.size(), false);
  cost[start] = 0;
  for (;;) {
    std::size_t now = nodes.size();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!done[i] && cost[i] < far && (now == nodes.size() || cost[i] < cost[now])) now = i;
    }
    if (now == nodes.size()) return std::nullopt;
    if (now == goal) break;
    done[now] = true;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const float there = cost[now] + (nodes[i] - nodes[now]).norm();
      if (done[i] || there >= cost[i] || !clear(nodes[now], nodes[i], obstacles)) continue;
      cost[i] = there;
      before[i] = now;
    }
  }
  std::vector<Vector2f> way;
  for (std::size_t i = before[goal]; i != start; i = before[i]) way.push_back(nodes[i]);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace counterpart
