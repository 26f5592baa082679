// A small software renderer of a draughts board with exact truth: every pixel is the mean of rays through it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/intrinsics.hpp"

namespace counterpart::test {

struct PaintedPiece {
  Cell cell;
  cv::Vec3b colour_bgr{30, 40, 60};
  double radius_m = 0.016;
  double height_m = 0.008;
};

struct BoardScene {
  BoardGeometry board;
  Intrinsics camera;
  Eigen::Isometry3d X_CB = Eigen::Isometry3d::Identity();
  cv::Vec3b light_bgr{170, 205, 225}, dark_bgr{50, 75, 110}, rim_bgr{40, 60, 90}, table_bgr{120, 120, 115};
  std::vector<PaintedPiece> pieces;
  // Seen in front of everything, in pixels; empty where nothing hides the board.
  std::function<std::optional<cv::Vec3b>(int x, int y)> before;
  double noise = 2;  // grey levels, standard deviation
  unsigned seed = 1;
};

// Rays per pixel side: 3 makes an edge right to a few hundredths of a pixel.
cv::Mat paint(const BoardScene& scene, int rays = 3);

// A camera looking at the middle of the board.
// distance_m from it, elevation_rad above its plane, azimuth_rad round it (0: from -y), rolled about its axis.
Eigen::Isometry3d looking_at_board(double distance_m, double elevation_rad, double azimuth_rad, double roll_rad = 0);

Intrinsics camera_720x576(double focal_px = 900);

// The largest distance in the picture between the board's crossings at two poses, pixels; NaN counts as huge.
double farthest_crossing_px(const BoardGeometry& board, const Intrinsics& camera_a, const Eigen::Isometry3d& a,
                            const Intrinsics& camera_b, const Eigen::Isometry3d& b);

// Dark pieces on the four low rows, light ones on the four high rows, as at the start.
std::vector<PaintedPiece> start_position(const BoardGeometry& board);

}  // namespace counterpart::test
