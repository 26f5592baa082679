// The camera's internal parameters from pictures of a game board, or of a chessboard, in several positions.
#pragma once

#include <cstdint>
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

// The same where the board's crossings are roughly known: expected_px by rows of (squares - 1) x (squares - 1).
[[nodiscard]] Result<BoardSight> sight_crossings(const cv::Mat& picture_bgr, int squares,
                                                 const std::vector<cv::Point2f>& expected_px, float allowed_px);

// How far the crossings of two sights lie from each other in the picture, pixels, mean.
double movement_px(const BoardSight& a, const BoardSight& b);

struct Calibration {
  Intrinsics camera;
  double rms_px = 0;
  double focal_sigma_px = 0;  // one standard deviation, as estimated from the residuals
};

// How the lens bends: by k1 alone, which few sights tell, or by k1, k2, p1 and p2.
enum class LensModel : std::uint8_t { k1 = 1, k1_k2_p1_p2 = 2 };

// Needs three sights from clearly different directions; says so if they do not suffice.
[[nodiscard]] Result<Calibration> calibrate(const std::vector<BoardSight>& sights, int width, int height,
                                            LensModel lens = LensModel::k1_k2_p1_p2);

}  // namespace counterpart
