#include "tracker_server/pose/lens_estimator.hpp"

#include <algorithm>

#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

constexpr std::size_t most_sights = 30;
constexpr double least_movement = 0.04;  // of the picture's width, from every sight there is
constexpr double worst_calibration_rms_px = 1.0;
constexpr double worst_focal_sigma = 0.02;  // of the focal length

std::vector<cv::Point2f> crossings(const BoardGeometry& board, const Intrinsics& camera,
                                   const Eigen::Isometry3d& X_CB) {
  const double half = 0.5 * board.squares * board.square_size_m;
  std::vector<cv::Point2f> points;
  for (int row = 1; row < board.squares; ++row)
    for (int col = 1; col < board.squares; ++col) {
      const Eigen::Vector2d p = project(
          camera, X_CB * Eigen::Vector3d(col * board.square_size_m - half, half - row * board.square_size_m, 0));
      points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
    }
  return points;
}

}  // namespace

std::optional<Calibration> LensEstimator::add(const cv::Mat& picture_bgr, const Intrinsics& camera,
                                              const Eigen::Isometry3d& X_CB) {
  if (sights_.size() >= most_sights) return std::nullopt;
  const std::vector<cv::Point2f> expected = crossings(board_, camera, X_CB);
  // A lens that is not known yet puts the outer crossings off by more than the pose does.
  const float square_px = static_cast<float>(cv::norm(expected[1] - expected[0]));
  auto sight = sight_crossings(picture_bgr, board_.squares, expected, 1.5F + 0.06F * square_px);
  if (!sight) return std::nullopt;
  const double least_px = least_movement * picture_bgr.cols;
  for (const BoardSight& other : sights_)
    if (movement_px(other, *sight) < least_px) return std::nullopt;
  sights_.push_back(std::move(*sight));
  if (sights_.size() < next_calibration_) return std::nullopt;
  next_calibration_ = sights_.size() + std::max<std::size_t>(2, sights_.size() / 3);
  const auto calibration = calibrate(sights_, picture_bgr.cols, picture_bgr.rows, LensModel::k1);
  if (!calibration || !(calibration->rms_px <= worst_calibration_rms_px)) return std::nullopt;
  if (!(calibration->focal_sigma_px <= worst_focal_sigma * calibration->camera.fx)) return std::nullopt;
  return *calibration;
}

}  // namespace counterpart
