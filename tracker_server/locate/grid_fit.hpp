// A board's homography made exact: all lines of its grid fitted to their edges in the picture.
#pragma once

#include <Eigen/Core>

#include "tracker_server/edges/pyramid.hpp"

namespace counterpart {

struct GridFit {
  Eigen::Matrix3d H;  // board in squares (u, v in 0..n) to pixels
  double rms_px = 0;  // of the edge points that were used
  double share = 0;   // of the edge points looked for
};

// first_light: the square at (0, 0) is a light one. Inner lines only: what lies beyond the outline is not known.
GridFit fit_grid(const Pyramid& pyramid, const Eigen::Matrix3d& start, int n, bool first_light);

}  // namespace counterpart
