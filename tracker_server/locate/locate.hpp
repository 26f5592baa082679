// Finds a draughts board in one picture, unaided, with pieces on it.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "tracker_server/edges/pyramid.hpp"

namespace counterpart {

struct LocatedBoard {
  Eigen::Matrix3d H;         // squares (column u, row v from corner 0, in 0..n) to pixels
  bool first_light = false;  // the square at corner 0 is a light one
  double support = 0;        // 0..1, how clearly the pattern was seen
  double contrast = 0;       // grey levels between light and dark squares

  // Outer corners of the playing surface, clockwise in the picture, the one nearest to the picture's top left first.
  std::array<Eigen::Vector2d, 4> corners(int n) const;
  Eigen::Vector2d to_pixel(double column, double row) const;
};

// n: squares a side. Empty rather than wrong: pictures in which the outline cannot be told are refused.
std::optional<LocatedBoard> locate_board(const cv::Mat& picture, int n);

// The board at given outer corners in any order; the lines in between are fitted if they can be seen near there.
std::optional<LocatedBoard> board_at_corners(const Pyramid& pyramid, const std::array<Eigen::Vector2d, 4>& corners,
                                             int n);

}  // namespace counterpart
