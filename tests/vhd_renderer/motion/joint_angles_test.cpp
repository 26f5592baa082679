#include "vhd_renderer/motion/joint_angles.hpp"

#include <cmath>

#include "tests/vhd_renderer/motion/human_measures.hpp"

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Vector3f;

const JointAngle& angle_named(const std::vector<JointAngle>& all, const std::string& name) {
  for (const JointAngle& one : all) {
    if (one.name == name) return one;
  }
  throw std::runtime_error("no angle " + name);
}

TEST(JointAngles, SeeABrokenElbowKneeAndWrist) {
  const Figure figure = mannequin();
  const Anatomy anatomy = anatomy_of(figure).value();
  BodyPose pose = bind_pose(figure);
  for (const JointAngle& one : joint_angles(figure, anatomy, pose)) {
    EXPECT_LT(one.excess_rad(), 0.02F) << one.name << " at bind";
  }
  const Limb& arm = anatomy.arms[right_side].limb;
  pose.turn[at(arm.middle)] = AngleAxisf(2.9F, arm.hinge_H);
  pose.turn[at(arm.end)] = AngleAxisf(1.9F, anatomy.arms[right_side].hand.R_HW.col(1));
  pose.turn[at(anatomy.neck.back())] = AngleAxisf(2.0F, Vector3f::UnitZ());
  update(figure, pose);
  const auto broken = joint_angles(figure, anatomy, pose);
  EXPECT_GT(angle_named(broken, "r_elbow flexion").excess_rad(), 0.1F);
  EXPECT_GT(angle_named(broken, "r_wrist flexion").excess_rad(), 0.1F);
  EXPECT_GT(angle_named(broken, "neck yaw").excess_rad(), 0.1F);
  EXPECT_EQ(angle_named(broken, "l_elbow flexion").excess_rad(), 0);
}

TEST(WristAngles, AreThoseThatTheHandWasMadeWith) {
  const Vector3f lower = Vector3f(0.3F, 0.9F, -0.2F).normalized();
  const Vector3f hinge = lower.cross(Vector3f(0.1F, 0.2F, 1)).normalized();
  for (const float thumb_side : {-1.F, 1.F}) {
    for (const float pronation : {-1.5F, 0.F, 1.2F}) {
      for (const float flexion : {-1.2F, 0.F, 1.3F}) {
        for (const float deviation : {-0.7F, 0.F, 0.4F}) {
          const WristAngles given{pronation, flexion, deviation};
          const WristAngles found = wrist_angles(hinge, lower, hand_frame(hinge, lower, given, thumb_side), thumb_side);
          EXPECT_NEAR(found.pronation_rad, pronation, 1e-4F);
          EXPECT_NEAR(found.flexion_rad, flexion, 1e-4F);
          EXPECT_NEAR(found.deviation_rad, deviation, 1e-4F);
        }
      }
    }
  }
}

TEST(JointLimits, HoldInEveryClipAndNothingJumps) {
  const Figure figure = mannequin();
  PoseJudge judge(figure);
  play_every_clip(figure, judge);
  expect_within_bounds(judge);
}

}  // namespace
}  // namespace counterpart
