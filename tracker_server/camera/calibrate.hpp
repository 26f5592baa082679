// The camera's internal parameters from pictures of a game board, or of a chessboard, in several positions.
#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/intrinsics.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// Crossings of one board in one picture, in step: where they lie on the board, in squares, and in the picture.
struct BoardSight {
  std::vector<cv::Point3f> on_board;
  std::vector<cv::Point2f> in_picture;
};

// Pieces may stand on the board; crossings that they hide are left out. Fewer than half of the crossings: no sight.
[[nodiscard]] Result<BoardSight> sight_board(const cv::Mat& picture_bgr, int squares);

struct Calibration {
  Intrinsics camera;
  double rms_px = 0;
  double focal_sigma_px = 0;  // one standard deviation, as estimated from the residuals
};

// Needs three sights from clearly different directions; says so if they do not suffice.
[[nodiscard]] Result<Calibration> calibrate(const std::vector<BoardSight>& sights, int width, int height);

}  // namespace counterpart
