// Pose of a plane, and the focal length if it is not known, from its homography.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/intrinsics.hpp"

namespace counterpart {

struct PlanePose {
  Eigen::Isometry3d X_CB;
  Intrinsics camera;
  double rms_px = 0;  // of the board's corners and lines' crossings against the homography
};

// H takes squares (column u, row v from the corner of row 0, column 0) to pixels; they run clockwise in the picture.
// Undistorted pixels are compared with undistorted ones: H is taken at its word at the crossings only.
PlanePose pose_of_board(const Eigen::Matrix3d& H, const BoardGeometry& board, const Intrinsics& camera);

// The same with a camera of which only the size is known. The focal length is the one that fits best, held near what
// cameras usually have where the view says little about it (a board seen squarely from above).
PlanePose pose_and_focal_of_board(const Eigen::Matrix3d& H, const BoardGeometry& board, int width, int height);

// The pose under which another camera, of nearly the same focal length, shows the board where this one does.
Eigen::Isometry3d pose_through_camera(const Eigen::Isometry3d& X_CB, const Intrinsics& camera, const Intrinsics& other,
                                      const BoardGeometry& board);

}  // namespace counterpart
