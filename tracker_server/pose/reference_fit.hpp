// The pose in a picture that motion has smeared: edges are hardly there, but what the board looked like in an earlier,
// sharper picture, drawn out along the way it moves while the shutter is open, is what this picture must show. Aligned
// by brightness: Lucas and Kanade (1981) on the board's plane, with the blur applied to the earlier picture as in Park
// et al., "ESM-Blur: handling and rendering blur in 3D tracking and augmentation" (2009).
#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/intrinsics.hpp"
#include "tracker_server/edges/pyramid.hpp"

namespace counterpart {

// A picture in which the board was seen well.
struct ReferenceView {
  Pyramid pyramid;
  Intrinsics camera;  // of that picture, or of the part that the pyramid holds
  Eigen::Isometry3d X_CB;
};

// What moves while the shutter is open is drawn out.
struct MotionBlur {
  std::optional<Eigen::Isometry3d> X_CB_earlier;  // two frames ago, if known: the way may be bent
  Eigen::Isometry3d X_CB_before, X_CB_now;        // a frame ago, and now: the middle of the exposure
  double shutter_share = 1;                       // of the time between: for so long the shutter was open
};

struct ReferenceFit {
  Eigen::Isometry3d X_CB;
  Eigen::Matrix<double, 6, 6> information;  // of (translation, rotation vector), in C, rotation about B's origin
  // 0..1: how many points of the board look as expected, and how closely. A hand over a third of it leaves two thirds.
  double likeness = 0;
  std::size_t searched = 0, agreeing = 0;  // points of the board
  double rms_px = 0;                       // by so much the agreeing points would have to move to look as expected
};

// camera: of the picture (or part) that the pyramid holds. Empty if too little of the board is in both pictures, or the
// fit leaves it.
std::optional<ReferenceFit> fit_to_reference(const Pyramid& pyramid, const Intrinsics& camera,
                                             const ReferenceView& reference, const BoardGeometry& board,
                                             const Eigen::Isometry3d& start_X_CB, const MotionBlur& blur);

}  // namespace counterpart
