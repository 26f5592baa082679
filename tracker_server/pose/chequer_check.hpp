// Does the picture look like this board at this pose? What the edges' positions alone cannot tell.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/intrinsics.hpp"

namespace counterpart {

struct ChequerCheck {
  double support = 0;   // -1..1: mean step between neighbouring squares, signed by colour, in typical steps
  double contrast = 0;  // grey levels: the median step
  int looked_at = 0;    // pairs of squares inside the picture
  // 0..1: share of the pairs whose darker square is clearly the one that should be lighter. What covers a board shows
  // few.
  double contradicted = 0;
  // Along the outermost squares (top row, bottom row, left, right), and along where more squares would follow.
  std::array<double, 4> rim{};
  std::array<double, 4> beyond{};
  std::array<bool, 4> rim_seen{}, beyond_seen{};  // enough of it lies in the picture

  // The pattern goes on beyond one side and is missing at the opposite one.
  bool shifted() const { return goes_on(0) || goes_on(1) || goes_on(2) || goes_on(3); }

  // The pattern is missing at one side, and the picture ends before it could go on beyond the opposite one.
  bool may_be_shifted() const;

  // Of a pose that is shifted, or may be: by how many squares to the right and up the board may lie from it, the
  // colours being as they are.
  std::vector<Eigen::Vector2i> ways_back() const;

 private:
  bool goes_on(std::size_t side) const;
  bool may_go_on(std::size_t side) const;
};

// typical_contrast: grey levels between light and dark squares as known so far; 0: as in this picture.
ChequerCheck check_chequer(const cv::Mat1b& grey, const BoardGeometry& board, const Intrinsics& camera,
                           const Eigen::Isometry3d& X_CB, double typical_contrast);

}  // namespace counterpart
