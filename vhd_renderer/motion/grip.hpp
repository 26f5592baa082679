// The grip on a piece: the paper's second subtask. Found once for a hand and a size of pieces.
#pragma once

#include <vector>

#include "vhd_renderer/motion/hand.hpp"

namespace counterpart {

// A piece on a crowded board. Metres.
struct GripTarget {
  float radius_m = 0.016F;
  float height_m = 0.008F;
  float square_m = 0.04F;  // neighbours stand a square's diagonal away
};

// The grip frame P is the piece's: origin at the centre of its foot, z up, x the way the hand points.
struct Grip {
  HandShape open;
  HandShape closed;
  Eigen::Isometry3f X_WP = Eigen::Isometry3f::Identity();  // where the piece lies in the hand
  float residual_mm = 0;                     // largest distance of a gripping finger's skin from the piece when closed
  std::vector<Eigen::Vector3f> open_skin_P;  // of the whole hand
};

// Thumb against forefinger and middle finger on the rim, tips down and off the board, the other fingers above the
// neighbours: found by Gauss-Newton, then closed until each finger's skin touches the rim.
Grip grip_on_piece(const Figure& figure, const HandParts& hand, const GripTarget& target);

// The whole open hand's skin in the grip frame.
std::vector<Eigen::Vector3f> open_skin_P(const Figure& figure, const HandParts& hand, const Grip& grip);

}  // namespace counterpart
