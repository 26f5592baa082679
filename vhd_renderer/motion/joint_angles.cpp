#include "vhd_renderer/motion/joint_angles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "vhd_renderer/motion/curves.hpp"
#include "vhd_renderer/motion/shoulder.hpp"

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

class AngleList {
 public:
  AngleList(const Figure& figure, const BodyPose& pose) : figure_(figure), pose_(pose) {}

  void add(const std::string& name, float angle_rad, float least_deg, float most_deg) {
    list_.push_back({name, angle_rad, {radians(least_deg), radians(most_deg)}});
  }
  void add(const std::string& name, float angle_rad, const AngleRange& range) {
    list_.push_back({name, angle_rad, range});
  }
  void add(const std::string& name, const Turn& turn, const AngleRange& pitch, float roll_deg, float yaw_deg) {
    add(name + " pitch", turn.pitch, pitch);
    add(name + " roll", turn.roll, -roll_deg, roll_deg);
    add(name + " yaw", turn.yaw, -yaw_deg, yaw_deg);
  }

  const Vector3f& place(int joint) const { return pose_.p_S[at(joint)]; }
  const Quaternionf& rotation(int joint) const { return pose_.G[at(joint)]; }
  const Quaternionf& turn(int joint) const { return pose_.turn[at(joint)]; }
  const std::string& name(int joint) const { return figure_.joints[at(joint)].name; }
  Vector3f bone(int from, int to) const { return (place(to) - place(from)).normalized(); }

  std::vector<JointAngle> take() { return std::move(list_); }

 private:
  const Figure& figure_;
  const BodyPose& pose_;
  std::vector<JointAngle> list_;
};

AngleRange degrees(float least, float most) {
  return {radians(least), radians(most)};
}

float between(const Vector3f& a, const Vector3f& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void add_fingers(const HandParts& hand, AngleList& list) {
  constexpr std::array<std::array<float, 2>, 3> flexion{{{-30, 95}, {-8, 112}, {-12, 90}}};
  for (std::size_t f = 0; f < 5; ++f) {
    const Finger& finger = hand.fingers[f];
    for (std::size_t k = 0; k < 3; ++k) {
      const Quaternionf& q = list.turn(finger.joint[k]);
      const std::string name = list.name(finger.joint[k]);
      if (f == thumb && k == 0) {
        list.add(name + " turn", AngleAxisf(q).angle(), 0, 62);
        continue;
      }
      const float bend = twist_about(q, finger.axis_H) + finger.bind_flex_rad[k];
      // A thumb's end bends backwards, too.
      list.add(name + " flexion", bend, f == thumb ? -15 : flexion[k][0], flexion[k][1]);
      if (k == 0) list.add(name + " spread", twist_about(q, finger.spread_axis_H), -25, 25);
    }
  }
}

void add_arm(const Anatomy& a, std::size_t s, AngleList& list) {
  const ArmParts& arm = a.arms[s];
  const float side = s == right_side ? 1.F : -1.F;
  const Limb& limb = arm.limb;
  if (arm.clavicle >= 0) {
    list.add(list.name(arm.clavicle) + " turn", AngleAxisf(list.turn(arm.clavicle)).angle(), 0, 40);
  }
  const Quaternionf trunk = list.rotation(a.trunk.back());
  const Vector3f upper = trunk.conjugate() * list.bone(limb.root, limb.middle);
  const std::string shoulder = list.name(limb.root);
  const Vector3f hinge = list.rotation(limb.middle) * limb.hinge_H;
  const ShoulderAngles angles = shoulder_angles(upper, trunk.conjugate() * hinge, side);
  list.add(shoulder + " backwards", angles.backwards_rad, joint_limit::arm_backwards);
  list.add(shoulder + " across", angles.across_rad, joint_limit::arm_across);
  list.add(shoulder + " inward turn", angles.inward_rad, joint_limit::arm_inward);
  const Vector3f lower = list.bone(limb.middle, limb.end);
  list.add(list.name(limb.middle) + " flexion", between(list.bone(limb.root, limb.middle), lower), 0, 152);
  const Matrix3f R_SW = list.rotation(limb.end).toRotationMatrix() * arm.hand.R_HW;
  const WristAngles wrist = wrist_angles(hinge, lower, R_SW, arm.hand.thumb_side);
  const std::string hand = list.name(limb.end);
  list.add(hand + " pronation", wrist.pronation_rad, joint_limit::pronation);
  list.add(hand + " flexion", wrist.flexion_rad, joint_limit::wrist_flexion);
  list.add(hand + " deviation", wrist.deviation_rad, joint_limit::wrist_deviation);
  add_fingers(arm.hand, list);
}

void add_leg(const Anatomy& a, std::size_t s, AngleList& list) {
  const LegParts& leg = a.legs[s];
  const Limb& limb = leg.limb;
  const float side = s == right_side ? 1.F : -1.F;
  const Vector3f thigh = list.rotation(a.root).conjugate() * list.bone(limb.root, limb.middle);
  list.add(list.name(limb.root) + " flexion", std::atan2(thigh.y(), -thigh.z()), -25, 125);
  list.add(list.name(limb.root) + " abduction", std::asin(std::clamp(side * thigh.x(), -1.F, 1.F)), -30, 45);
  list.add(list.name(limb.middle) + " flexion",
           between(list.bone(limb.root, limb.middle), list.bone(limb.middle, limb.end)), 0, 155);
  const Turn foot = turn_of((list.rotation(limb.middle).conjugate() * list.rotation(limb.end)).normalized());
  list.add(list.name(limb.end), foot, degrees(-42, 55), 32, 45);
  if (leg.toe >= 0) list.add(list.name(leg.toe) + " extension", -turn_of(list.turn(leg.toe)).pitch, -40, 65);
}

}  // namespace

float JointAngle::excess_rad() const {
  return range.excess(angle_rad);
}

Turn turn_of(const Quaternionf& rotation) {
  const Matrix3f R = rotation.toRotationMatrix();
  const Vector3f forward = R.col(1);
  return {-std::asin(std::clamp(forward.z(), -1.F, 1.F)), std::atan2(-R(2, 0), R(2, 2)),
          std::atan2(-forward.x(), forward.y())};
}

std::vector<JointAngle> joint_angles(const Figure& figure, const Anatomy& a, const BodyPose& pose) {
  AngleList list(figure, pose);
  const Quaternionf root = list.rotation(a.root);
  const Quaternionf trunk = list.rotation(a.trunk.back());
  list.add("spine", turn_of((root.conjugate() * trunk).normalized()), degrees(-32, 75), 35, 45);
  list.add("neck", turn_of((trunk.conjugate() * list.rotation(a.neck.back())).normalized()), degrees(-60, 55), 42, 80);
  if (a.jaw >= 0) list.add("jaw", turn_of(list.turn(a.jaw)).pitch, -1, 26);
  for (const std::size_t s : {left_side, right_side}) {
    if (a.eyes[s] >= 0) list.add(list.name(a.eyes[s]), turn_of(list.turn(a.eyes[s])), degrees(-35, 38), 8, 40);
    add_arm(a, s, list);
    add_leg(a, s, list);
  }
  return list.take();
}

}  // namespace counterpart
