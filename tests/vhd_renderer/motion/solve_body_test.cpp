#include <cmath>
#include <random>

#include "tests/vhd_renderer/motion/human_measures.hpp"
#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

// Hands are sent from one random place round the body to the next, some of them inside it or out of reach, in less than
// a second each. Shoulders, elbows and wrists stay what a person has; where a goal rushes an arm through a place that
// it can neither pass nor get round in time, a few frames in a thousand may show it.
TEST(SolveBody, HardlyAnyGoalTakesAnArmBeyondItsRange) {
  const Figure figure = mannequin();
  const Anatomy anatomy = anatomy_of(figure).value();
  const Home home = home_of(Scene{}, anatomy);
  std::mt19937 random(3);
  const auto any = [&](float low, float high) {
    return lerp(low, high, static_cast<float>(random() % 10'000) / 10'000);
  };
  const auto any_goal = [&](std::size_t side) {
    const float out = side == right_side ? 1.F : -1.F;
    ArmGoal goal;
    goal.wrist_S =
        Vector3f(out * any(-0.45F, 0.75F), home.seat_y + any(-0.2F, 0.75F), home.seat_hip_z + any(-0.3F, 1.1F));
    goal.R_SW = Quaternionf(any(-1, 1), any(-1, 1), any(-1, 1), any(-1, 1)).normalized();
    goal.help = any(0, 1);
    return goal;
  };
  SolvedBody body;
  std::array<ArmGoal, 2> from{any_goal(left_side), any_goal(right_side)};
  int beyond = 0;
  std::string worst;
  float most = 0;
  for (int leg = 0; leg < 300; ++leg) {
    const std::array<ArmGoal, 2> to{any_goal(left_side), any_goal(right_side)};
    constexpr int frames = 20;
    for (int f = 1; f <= frames; ++f) {
      const float u = minimum_jerk(static_cast<float>(f) / frames);
      BodyControls c;
      sit(home, anatomy, c);
      c.table_z_m = home.table_z;
      c.table_edge_y_m = home.table_edge_y;
      c.dt_s = 0.04F;
      for (const std::size_t s : {left_side, right_side}) {
        c.arms[s] = to[s];
        c.arms[s].wrist_S = from[s].wrist_S + (to[s].wrist_S - from[s].wrist_S) * u;
        c.arms[s].R_SW = from[s].R_SW.slerp(u, to[s].R_SW);
        c.arms[s].help = lerp(from[s].help, to[s].help, u);
      }
      solve_body(figure, anatomy, c, body);
      for (const JointAngle& angle : joint_angles(figure, anatomy, body.pose)) {
        if (angle.excess_rad() < radians(1)) continue;
        ++beyond;
        if (angle.excess_rad() < most) continue;
        most = angle.excess_rad();
        worst = angle.name + " in leg " + std::to_string(leg) + ", frame " + std::to_string(f);
      }
    }
    from = to;
  }
  constexpr int looked_at = 300 * 20 * 2;  // arms
  EXPECT_LT(beyond, looked_at * 5 / 1000) << worst << " by " << most * 180 / pi_f << " degrees";
}

}  // namespace
}  // namespace counterpart
