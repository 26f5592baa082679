#include "vhd_renderer/motion/walk_round.hpp"

#include <algorithm>

#include "tests/vhd_renderer/motion/rehearsal.hpp"

namespace counterpart {
namespace {

using Eigen::Vector2f;

float nearest_to(const Vector2f& middle, const std::vector<Vector2f>& way) {
  float nearest = 1e9F;
  for (std::size_t i = 0; i + 1 < way.size(); ++i) {
    for (int k = 0; k <= 50; ++k) {
      nearest = std::min(nearest, (way[i] + (way[i + 1] - way[i]) * (0.02F * static_cast<float>(k)) - middle).norm());
    }
  }
  return nearest;
}

TEST(WayRound, GoesStraightWhereNothingStands) {
  const auto way = way_round({-2, 0}, {2, 0}, {{{0, 3}, {0.5F, 0.5F}, 0}});
  ASSERT_TRUE(way);
  EXPECT_TRUE(way->empty());
}

TEST(WayRound, KeepsClearOfAThingInTheWay) {
  const Footprint thing{{0, 0.1F}, {0.3F, 0.3F}, 0.6F};
  auto way = way_round({-2, 0}, {2, 0}, {thing});
  ASSERT_TRUE(way);
  ASSERT_FALSE(way->empty());
  way->insert(way->begin(), {-2, 0});
  way->emplace_back(2, 0);
  EXPECT_GT(nearest_to(thing.middle_S, *way), 0.3F + body_clearance_m - 1e-3F);
}

TEST(WayRound, SaysSoWhereThereIsNone) {
  std::vector<Footprint> walls;  // a closed pen round the goal
  for (const float s : {-1.F, 1.F}) {
    walls.push_back({{2 + s, 0}, {0.1F, 1.2F}, 0});
    walls.push_back({{2, s}, {1.2F, 0.1F}, 0});
  }
  EXPECT_FALSE(way_round({-2, 0}, {2, 0}, walls));
}

TEST(Director, WalksRoundABoxInTheRoom) {
  Rehearsal r;
  Scene scene = board_with({});
  SceneBox box{"shelf", {}, {0.3, 0.3, 1.2}};
  box.X_BO.p = {0.95, -1.0, -0.14};
  scene.boxes = {box};
  r.frame({}, &scene);
  Command sit;
  sit.id = 1;
  sit.action = Navigate{"seat", {}, 0, "walk"};
  r.frame({sit});
  float nearest = 9;
  for (int i = 0; i < 600 && !r.ended(1); ++i) {
    r.frame();
    nearest = std::min(nearest, (r.joint("HumanoidRoot") - Eigen::Vector3f(0.95F, -1.0F, 0)).head<2>().norm());
  }
  EXPECT_EQ(r.said[1].back().state, FeedbackState::finished) << r.said[1].back().code;
  EXPECT_GT(nearest, 0.15F + 0.22F) << "his middle from the middle of the box";
}

}  // namespace
}  // namespace counterpart
