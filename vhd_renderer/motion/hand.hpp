// Hand shapes, and the grip on a piece: the paper's second subtask.
#pragma once

#include <array>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vhd_renderer/motion/anatomy.hpp"
#include "vhd_renderer/motion/pose.hpp"

namespace counterpart {

struct FingerBend {
  std::array<float, 3> flex_rad{};  // bend at the three joints, from straight; the thumb's first is unused
  float spread_rad = 0;
};

struct HandShape {
  std::array<FingerBend, 5> fingers;
  Eigen::Vector3f thumb_turn_W{0, 0, 0};  // rotation vector of the thumb's saddle joint from bind, y mirrored by side
};

HandShape blend(const HandShape& a, const HandShape& b, float t);

// "relaxed", "flat", "fist", "point", "open", "thumb_up", "chin", "watch"; unknown names give "relaxed".
HandShape hand_shape(const std::string& name);

void apply(const Figure& figure, const HandParts& hand, const HandShape& shape, BodyPose& pose);

struct Fingertip {
  Eigen::Vector3f pad;
  Eigen::Vector3f pad_normal;
  Eigen::Vector3f tip;
};

// In the hand frame W.
Fingertip fingertip_W(const Figure& figure, const HandParts& hand, const HandShape& shape, std::size_t finger);

// The grip frame P is the piece's: origin at the centre of its foot, z up, x the way the hand points.
struct Grip {
  HandShape open;
  HandShape closed;
  Eigen::Isometry3f X_WP = Eigen::Isometry3f::Identity();  // where the piece lies in the hand
  float residual_mm = 0;                                   // largest distance of a pad from the rim in the closed grip
};

// Thumb against index and middle finger on the rim of a disc, tips down, found by Gauss-Newton on the pads' places.
Grip grip_on_disc(const Figure& figure, const HandParts& hand, float radius_m, float height_m);

}  // namespace counterpart
