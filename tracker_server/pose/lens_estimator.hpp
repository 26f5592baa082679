// The whole camera, principal point and distortion included, from the board that is being tracked: sights from clearly
// different places are kept, and from time to time a calibration (Zhang 2000) is made of them.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "protocol/vocabulary/board_geometry.hpp"
#include "tracker_server/camera/calibrate.hpp"

namespace counterpart {

class LensEstimator {
 public:
  explicit LensEstimator(const BoardGeometry& board) : board_(board) {}

  // The picture, and the pose that was found in it with the camera as it is known so far. A better camera if this
  // picture made one: it then costs some ten milliseconds, otherwise less than one.
  std::optional<Calibration> add(const cv::Mat& picture_bgr, const Intrinsics& camera, const Eigen::Isometry3d& X_CB);

 private:
  BoardGeometry board_;
  std::vector<BoardSight> sights_;
  std::size_t next_calibration_ = 6;
};

}  // namespace counterpart
