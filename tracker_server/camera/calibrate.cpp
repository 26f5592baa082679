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
  cv::Mat1b grey;
  cv::cvtColor(picture_bgr, grey, cv::COLOR_BGR2GRAY);

  std::vector<cv::Point2f> expected;
  std::vector<cv::Point3f> places;
  for (int row = 1; row < squares; ++row)
    for (int col = 1; col < squares; ++col) {
      const Eigen::Vector2d p = board->to_pixel(col, row);
      expected.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
      places.emplace_back(static_cast<float>(col), static_cast<float>(row), 0.0F);
    }
  // Near enough to a crossing that its window holds no other one.
  const double square_px = (board->to_pixel(1, 1) - board->to_pixel(0, 1)).norm();
  const int half = std::clamp(static_cast<int>(square_px / 5), 3, 12);
  std::vector<cv::Point2f> found = expected;
  cv::cornerSubPix(grey, found, cv::Size(half, half), cv::Size(-1, -1),
                   cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 40, 0.005));
  BoardSight sight;
  for (std::size_t i = 0; i < found.size(); ++i) {
    // A crossing under a piece runs away to the piece's rim.
    if (cv::norm(found[i] - expected[i]) > 1.5 + 0.02 * square_px) continue;
    sight.on_board.push_back(places[i]);
    sight.in_picture.push_back(found[i]);
  }
  if (sight.in_picture.size() < found.size() / 2)
    return failure(ErrorCode::not_found, "Too little of the board can be seen in the picture.");
  return sight;
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

Result<Calibration> calibrate(const std::vector<BoardSight>& sights, int width, int height) {
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
  try {
    rms = cv::calibrateCamera(on_board, in_picture, cv::Size(width, height), K, dist, rotations, translations,
                              deviations, extrinsic_deviations, view_errors,
                              cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_FIX_ASPECT_RATIO | cv::CALIB_FIX_K3);
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
