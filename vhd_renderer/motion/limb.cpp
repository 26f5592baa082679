#include "vhd_renderer/motion/limb.hpp"

#include <algorithm>
#include <cmath>

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

// A limb is never pulled quite straight: a stretched arm looks dead and its elbow has no direction.
constexpr float longest_share = 0.995F;

// Nor is it ever closed farther than flesh lets it.
constexpr float most_bent_rad = 2.6F;

float usable_distance(const Limb& limb, float distance) {
  const float shortest = std::sqrt(limb.upper_m * limb.upper_m + limb.lower_m * limb.lower_m +
                                   2 * limb.upper_m * limb.lower_m * std::cos(most_bent_rad));
  return std::clamp(distance, shortest, longest_share * limb.length_m());
}

// Of the upper bone's twist joint.
Vector3f twist_axis(const Figure& figure, const Limb& limb) {
  return (figure.joints[at(limb.middle)].X_HJ.translation() - figure.joints[at(limb.root_twist)].X_HJ.translation())
      .normalized();
}

}  // namespace

float root_twist_of(const Figure& figure, const Limb& limb, const BodyPose& pose) {
  return limb.root_twist < 0 ? 0 : twist_about(pose.turn[at(limb.root_twist)], twist_axis(figure, limb));
}

LimbBend bend_of(const Limb& limb, const Vector3f& root_S, const Vector3f& end_S, const Vector3f& pole_S) {
  Vector3f n = end_S - root_S;
  const float raw = n.norm();
  n = raw > 1e-6F ? Vector3f(n / raw) : Vector3f(0, 0, -1);
  const float d = usable_distance(limb, raw);
  const float a = (limb.upper_m * limb.upper_m - limb.lower_m * limb.lower_m + d * d) / (2 * d);
  const float h = std::sqrt(std::max(0.F, limb.upper_m * limb.upper_m - a * a));
  Vector3f e = pole_S - n * n.dot(pole_S);
  e = e.squaredNorm() > 1e-8F ? Vector3f(e.normalized()) : n.unitOrthogonal();
  LimbBend bend;
  bend.middle_S = root_S + n * a + e * h;
  bend.upper_S = (bend.middle_S - root_S).normalized();
  bend.lower_S = (root_S + n * d - bend.middle_S).normalized();
  const Vector3f hinge = bend.upper_S.cross(bend.lower_S);
  bend.hinge_S =
      hinge.squaredNorm() > 1e-8F ? Vector3f(hinge.normalized()) : Vector3f(bend.upper_S.cross(-pole_S).normalized());
  return bend;
}

float solve_limb(const Figure& figure, const Limb& limb, const LimbGoal& goal, BodyPose& pose) {
  const auto joint = [](int j) { return static_cast<std::size_t>(j); };
  const auto update = [&](int j) {
    if (j >= 0) update_chain(figure, pose, {j});
  };
  pose.turn[joint(limb.root)].setIdentity();
  update(limb.root);
  const Vector3f root = pose.p_S[joint(limb.root)];
  const LimbBend bend = bend_of(limb, root, goal.end_S, goal.pole_S);
  const Vector3f& upper = bend.upper_S;
  const Vector3f& lower = bend.lower_S;
  const Vector3f& hinge = bend.hinge_S;

  // Upper bone: the whole rotation is split into swing and a twist about the bone; part of the twist is left to the
  // twist joint, so that the shoulder's skin does not wring.
  const Quaternionf whole = align(limb.upper_H, limb.hinge_H, upper, hinge);
  const int parent = figure.joints[joint(limb.root)].parent;
  const Quaternionf above = pose.G[joint(parent)];
  const Quaternionf local = above.conjugate() * whole;
  if (limb.root_twist >= 0) {
    const float twist = goal.root_twist.nearest(goal.root_twist_share * twist_about(local, limb.upper_H));
    const Quaternionf part(AngleAxisf(-twist, limb.upper_H));
    set_rotation(figure, pose, limb.root, (above * local * part).normalized());
    const Vector3f bone_H = twist_axis(figure, limb);
    set_rotation(figure, pose, limb.root_twist, (pose.G[joint(limb.root)] * AngleAxisf(twist, bone_H)).normalized());
    update(limb.middle);
  } else {
    set_rotation(figure, pose, limb.root, whole);
    update(limb.middle);
  }

  const Quaternionf fore = align(limb.lower_H, limb.hinge_H, lower, hinge);
  set_rotation(figure, pose, limb.middle, fore);
  if (limb.middle_twist >= 0) {
    const float twist = goal.end_twist_share * twist_about(fore.conjugate() * goal.end_G, limb.lower_H);
    const Vector3f bone_H =
        (figure.joints[joint(limb.end)].X_HJ.translation() - figure.joints[joint(limb.middle_twist)].X_HJ.translation())
            .normalized();
    set_rotation(figure, pose, limb.middle_twist, (fore * AngleAxisf(twist, bone_H)).normalized());
  }
  set_rotation(figure, pose, limb.end, goal.end_G);
  return (pose.p_S[joint(limb.end)] - goal.end_S).norm();
}

}  // namespace counterpart
