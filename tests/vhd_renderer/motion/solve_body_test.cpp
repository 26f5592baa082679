#include <cmath>
#include <random>

#include "tests/vhd_renderer/motion/human_measures.hpp"
#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

// Hands are sent from one random place round the body to the next, some of them inside it or out of reach, in less than
// a second each. Says which joint left its range, and when; empty: none did.
std::string out_of_range(const Figure& figure, unsigned seed) {
  const Anatomy anatomy = anatomy_of(figure).value();
  const Home home = home_of(Scene{}, anatomy);
  std::mt19937 random(seed);
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
  for (int leg = 0; leg < 150; ++leg) {
    const std::array<ArmGoal, 2> to{any_goal(left_side), any_goal(right_side)};
    constexpr int frames = 20;
    for (int f = 1; f <= frames; ++f) {
      const float u = minimum_jerk(static_cast<float>(f) / frames);
      BodyControls c;
      sit(home, anatomy, c);
      c.table_z_m = home.table_z;
      c.table_edge_y_m = home.table_edge_y;
      c.board_half_m = home.board_half_m;
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
        return angle.name + " by " + std::to_string(angle.excess_rad() * 180 / pi_f) + " degrees in leg " +
               std::to_string(leg) + ", frame " + std::to_string(f);
      }
    }
    from = to;
  }
  return "";
}

TEST(SolveBody, NoGoalTakesAJointBeyondItsRange) {
  EXPECT_EQ(out_of_range(mannequin(), 1), "");
  EXPECT_EQ(out_of_range(mannequin(), 3), "");
  EXPECT_EQ(out_of_range(scaled(mannequin(), 0.85F), 1), "");
  EXPECT_EQ(out_of_range(scaled(mannequin(), 1.15F), 1), "");
}

}  // namespace
}  // namespace counterpart
