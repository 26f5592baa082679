// Which N x N squares of a lattice are the board: the chequer pattern must fill them and end at their outline.
#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace counterpart {

struct BoardWindow {
  int u = 0, v = 0;          // lattice coordinates of the window's first corner
  bool first_light = false;  // whether the square at the first corner is a light one
  double seen = 0;           // 0..1: share of its edges that lie in the picture
  double support = 0;        // -1..1: mean evidence of the pattern inside
  double weakest_side = 0;   // evidence along the weakest of the four outermost rows and columns
  double beyond = 0;         // evidence that the pattern goes on beyond the outline, worst side
  double margin = 0;         // how much better than the best other window, in outermost rows' worth of evidence
  double contrast = 0;       // grey levels between light and dark squares, typical
};

// H takes lattice coordinates to pixels of `grey`; the window is sought over the lattice points u0..u1 x v0..v1 and up
// to n - 1 squares round them. Empty if no window lies in the picture.
std::optional<BoardWindow> find_board_window(const cv::Mat1b& grey, const Eigen::Matrix3d& H, int n, int u0, int u1,
                                             int v0, int v1);

// The same measure for one given window: is this really a board, and does it end there?
BoardWindow judge_board_window(const cv::Mat1b& grey, const Eigen::Matrix3d& H, int n, int u, int v);

}  // namespace counterpart
