#include "vhd_renderer/motion/wrist.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

}  // namespace

WristAngles wrist_angles(const Vector3f& hinge, const Vector3f& lower, const Matrix3f& R_W, float thumb_side) {
  WristAngles w;
  const Vector3f l_W = R_W.transpose() * lower;
  w.flexion_rad = std::atan2(l_W.z(), l_W.x());
  w.deviation_rad = std::asin(std::clamp(-thumb_side * l_W.y(), -1.F, 1.F));
  // The hand brought in line with the forearm by its bend alone; then its thumb against where the elbow closes to.
  const Vector3f thumb_in_line = Quaternionf::FromTwoVectors(R_W.col(0), lower) * (R_W.col(1) * thumb_side);
  const Vector3f closing = hinge.cross(lower);
  w.pronation_rad = thumb_side * std::atan2(closing.cross(thumb_in_line).dot(lower), closing.dot(thumb_in_line));
  return w;
}

Matrix3f hand_frame(const Vector3f& hinge, const Vector3f& lower, const WristAngles& w, float thumb_side) {
  // The straight hand first: x along the forearm, the thumb turned about it from where the elbow closes to.
  const Vector3f closing = hinge.cross(lower).normalized();
  const Vector3f thumb = AngleAxisf(thumb_side * w.pronation_rad, lower) * closing;
  Matrix3f straight;
  straight << lower, thumb * thumb_side, lower.cross(thumb * thumb_side);
  // The forearm as the bent hand sees it; the bend is the shortest turn that makes it so.
  const float flat = std::cos(w.deviation_rad);
  const Vector3f l_W(flat * std::cos(w.flexion_rad), -thumb_side * std::sin(w.deviation_rad),
                     flat * std::sin(w.flexion_rad));
  return straight * Quaternionf::FromTwoVectors(l_W, Vector3f::UnitX()).toRotationMatrix();
}

WristAngles held_back(const WristAngles& wanted, const WristAngles& before, float dt_s) {
  constexpr float fastest_rad_s = 6.6F;
  const auto step = [&](float to, float from, const AngleRange& range) {
    const float legal = range.nearest(to);
    return dt_s > 0 ? std::clamp(legal, from - fastest_rad_s * dt_s, from + fastest_rad_s * dt_s) : legal;
  };
  return {step(wanted.pronation_rad, before.pronation_rad, joint_limit::pronation),
          step(wanted.flexion_rad, before.flexion_rad, joint_limit::wrist_flexion),
          step(wanted.deviation_rad, before.deviation_rad, joint_limit::wrist_deviation)};
}

}  // namespace counterpart
