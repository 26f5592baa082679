#include "tracker_server/camera/calibrate.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "tracker_server/locate/locate.hpp"

namespace counterpart {

Result<BoardSight> sight_board(const cv::Mat& picture_bgr, int squares) {
  const auto board = locate_board(picture_bgr, squares);
  if (!board) return failure(ErrorCode::not_found, "No board in the picture.");
  std::vector<cv::Point2f> expected;
  for (int row = 1; row < squares; ++row)
    for (int col = 1; col < squares; ++col) {
      const Eigen::Vector2d p = board->to_pixel(col, row);
      expected.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    }
  return sight_crossings(picture_bgr, squares, expected,
                         1.5F + 0.02F * static_cast<float>(cv::norm(expected[1] - expected[0])));
}

Result<BoardSight> sight_crossings(const cv::Mat& picture_bgr, int squares, const std::vector<cv::Point2f>& expected_px,
                                   float allowed_px) {
  cv::Mat1b grey;
  cv::cvtColor(picture_bgr, grey, cv::COLOR_BGR2GRAY);
  // Near enough to a crossing that its window holds no other one.
  const double square_px = cv::norm(expected_px[1] - expected_px[0]);
  const int half = std::clamp(static_cast<int>(square_px / 5), 3, 12);
  const cv::Rect2f inside(static_cast<float>(half), static_cast<float>(half), static_cast<float>(grey.cols - 2 * half),
                          static_cast<float>(grey.rows - 2 * half));
  std::vector<cv::Point2f> expected;
  BoardSight sight;
  for (std::size_t i = 0; i < expected_px.size(); ++i) {
    if (!inside.contains(expected_px[i])) continue;
    const auto per_row = static_cast<std::size_t>(squares - 1);
    expected.push_back(expected_px[i]);
    sight.on_board.emplace_back(static_cast<float>(i % per_row + 1), static_cast<float>(i / per_row + 1), 0.0F);
  }
  if (expected.size() < expected_px.size() / 2)
    return failure(ErrorCode::not_found, "Too little of the board can be seen in the picture.");
  sight.in_picture = expected;
  cv::cornerSubPix(grey, sight.in_picture, cv::Size(half, half), cv::Size(-1, -1),
                   cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 40, 0.005));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    // A crossing under a piece runs away to the piece's rim.
    if (cv::norm(sight.in_picture[i] - expected[i]) > static_cast<double>(allowed_px)) continue;
    sight.in_picture[kept] = sight.in_picture[i];
    sight.on_board[kept++] = sight.on_board[i];
  }
  sight.in_picture.resize(kept);
  sight.on_board.resize(kept);
  if (kept < expected_px.size() / 2)
    return failure(ErrorCode::not_found, "Too little of the board can be seen in the picture.");
  return sight;
}

double movement_px(const BoardSight& a, const BoardSight& b) {
  double sum = 0;
  const std::size_t count = std::min(a.in_picture.size(), b.in_picture.size());
  for (std::size_t i = 0; i < count; ++i) sum += cv::norm(a.in_picture[i] - b.in_picture[i]);
  return sum / static_cast<double>(count);
}

namespace {

// A board seen squarely is as large through a long lens from afar as through a short one from near: only tilted views
// tell the focal length (Zhang 2000, section 3), whatever the fit says of its own certainty.
constexpr double kTilt_rad = 0.17;
constexpr int kTiltedViews = 3;

int tilted_views(const std::vector<cv::Mat>& rotations) {
  int count = 0;
  for (const cv::Mat& rotation : rotations) {
    cv::Mat R_CB;
    cv::Rodrigues(rotation, R_CB);
    if (std::acos(std::min(1.0, std::abs(R_CB.at<double>(2, 2)))) > kTilt_rad) ++count;
  }
  return count;
}

}  // namespace

Result<Calibration> calibrate(const std::vector<BoardSight>& sights, int width, int height, LensModel lens) {
  if (sights.size() < 3)
    return failure(ErrorCode::unavailable,
                   "A calibration needs the board in at least 3 pictures, from clearly "
                   "different directions; it was found in " +
                       std::to_string(sights.size()) + ".");
  std::vector<std::vector<cv::Point3f>> on_board;
  std::vector<std::vector<cv::Point2f>> in_picture;
  for (const BoardSight& sight : sights) {
    on_board.push_back(sight.on_board);
    in_picture.push_back(sight.in_picture);
  }
  cv::Mat1d K = cv::Mat1d::eye(3, 3), dist = cv::Mat1d::zeros(5, 1);
  const double usual_focal = 0.95 * std::max(width, height);
  K(0, 0) = K(1, 1) = usual_focal;
  K(0, 2) = 0.5 * (width - 1);
  K(1, 2) = 0.5 * (height - 1);
  std::vector<cv::Mat> rotations, translations;
  cv::Mat deviations, extrinsic_deviations, view_errors;
  double rms = 0;
  int flags = cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_ASPECT_RATIO | cv::CALIB_FIX_K3;
  if (lens == LensModel::k1) flags |= cv::CALIB_FIX_K2 | cv::CALIB_ZERO_TANGENT_DIST;
  try {
    rms = cv::calibrateCamera(on_board, in_picture, cv::Size(width, height), K, dist, rotations, translations,
                              deviations, extrinsic_deviations, view_errors, flags);
  } catch (const cv::Exception& error) {
    return failure(ErrorCode::not_a_number, std::string("The calibration did not converge: ") + error.what());
  }
  Calibration result;
  result.rms_px = rms;
  // With the aspect ratio fixed, fy is the one that is estimated; the deviation of fx is left at zero.
  result.focal_sigma_px = deviations.at<double>(1);
  result.camera.width = width;
  result.camera.height = height;
  result.camera.fx = K(0, 0);
  result.camera.fy = K(1, 1);
  result.camera.cx = K(0, 2);
  result.camera.cy = K(1, 2);
  for (std::size_t i = 0; i < 5; ++i) result.camera.dist[i] = dist(static_cast<int>(i), 0);
  const bool sensible = std::isfinite(rms) && result.camera.fx > 0.2 * width && result.camera.fx < 20.0 * width &&
                        result.focal_sigma_px < 0.05 * result.camera.fx && tilted_views(rotations) >= kTiltedViews;
  if (!sensible)
    return failure(ErrorCode::unavailable,
                   "The pictures do not tell the focal length: show the board tilted, from "
                   "several sides, near and far.");
  return result;
}

}  // namespace counterpart
