// The way on foot round what stands in the room.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace counterpart {

// What nobody walks through, seen from above: a rectangle on the floor, in S.
struct Footprint {
  Eigen::Vector2f middle_S{0, 0};
  Eigen::Vector2f half_m{0, 0};  // along its own axes
  float turn_rad = 0;            // of its own x axis from S's
};

// How near a body's middle may come to an obstacle.
inline constexpr float body_clearance_m = 0.27F;

// The corners of the shortest way from a to b (without them; empty: straight on) that keeps clear of the obstacles;
// nothing if there is none. Where a or b itself is nearer to an obstacle, it may be left and reached straight.
std::optional<std::vector<Eigen::Vector2f>> way_round(const Eigen::Vector2f& a, const Eigen::Vector2f& b,
                                                      const std::vector<Footprint>& obstacles);

}  // namespace counterpart
