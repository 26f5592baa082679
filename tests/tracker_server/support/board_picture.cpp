#include "tests/tracker_server/support/board_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/core.hpp>

#include "tracker_server/pose/projection.hpp"

namespace counterpart::test {
namespace {

using Eigen::Vector3d;

cv::Vec3b ground_colour(const BoardScene& scene, double x, double y) {
  const BoardGeometry& board = scene.board;
  const double half = 0.5 * board.squares * board.square_size_m;
  const auto cell = cell_at_B({x, y, 0}, board);
  if (cell) {
    const bool played = (cell->row + cell->col) % 2 != 0;
    return played == (board.played_on == SquareColour::dark) ? scene.dark_bgr : scene.light_bgr;
  }
  const double edge = half + board.border_m;
  return std::abs(x) <= edge && std::abs(y) <= edge ? scene.rim_bgr : scene.table_bgr;
}

// Upright cylinders on the plane z = 0.
cv::Vec3b colour_along(const BoardScene& scene, const Vector3d& eye, const Vector3d& ray) {
  double nearest = std::numeric_limits<double>::max();
  cv::Vec3b colour = scene.table_bgr;
  if (ray.z() < 0) {
    nearest = -eye.z() / ray.z();
    colour = ground_colour(scene, eye.x() + nearest * ray.x(), eye.y() + nearest * ray.y());
  }
  for (const PaintedPiece& piece : scene.pieces) {
    const Point3 centre = centre_of_cell_B(piece.cell, scene.board);
    const double cx = eye.x() - centre[0], cy = eye.y() - centre[1];
    if (ray.z() < 0) {  // most rays pass far from the piece
      const double t = -eye.z() / ray.z();
      const double reach = piece.radius_m - piece.height_m * std::hypot(ray.x(), ray.y()) / ray.z();
      if (std::abs(cx + t * ray.x()) > reach || std::abs(cy + t * ray.y()) > reach) continue;
    }
    const auto hit = [&](double t, double shade) {
      if (!(t > 0 && t < nearest)) return;
      nearest = t;
      for (int c = 0; c < 3; ++c) colour[c] = cv::saturate_cast<std::uint8_t>(shade * piece.colour_bgr[c]);
    };
    if (ray.z() < 0) {
      const double t = (piece.height_m - eye.z()) / ray.z();
      const double r = std::hypot(cx + t * ray.x(), cy + t * ray.y());
      // A turned rim, as pieces have.
      if (r <= piece.radius_m) hit(t, r > 0.75 * piece.radius_m && r < 0.88 * piece.radius_m ? 1.35 : 1.0);
    }
    const double a = ray.x() * ray.x() + ray.y() * ray.y();
    const double b = cx * ray.x() + cy * ray.y();
    const double c = cx * cx + cy * cy - piece.radius_m * piece.radius_m;
    const double root = b * b - a * c;
    if (a > 0 && root >= 0) {
      const double t = (-b - std::sqrt(root)) / a;
      const double z = eye.z() + t * ray.z();
      if (z >= 0 && z <= piece.height_m) hit(t, 0.7);
    }
  }
  return colour;
}

}  // namespace

cv::Mat paint(const BoardScene& scene, int rays) {
  const Intrinsics& camera = scene.camera;
  const Eigen::Isometry3d X_BC = scene.X_CB.inverse();
  const Vector3d eye = X_BC.translation();
  const auto seen_at = [&](double x, double y) {
    const Eigen::Vector2d n = normalised_of_pixel(camera, {x, y});
    return colour_along(scene, eye, X_BC.linear() * Vector3d(n.x(), n.y(), 1));
  };
  cv::Mat3b middles(camera.height, camera.width);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const auto hidden = scene.before ? scene.before(x, y) : std::nullopt;
      middles(y, x) = hidden ? *hidden : seen_at(x, y);
    }
  // Only where an edge passes do the other rays through a pixel show anything else.
  const auto is_plain = [&](int x, int y) {
    for (int v = std::max(0, y - 1); v <= std::min(camera.height - 1, y + 1); ++v)
      for (int u = std::max(0, x - 1); u <= std::min(camera.width - 1, x + 1); ++u)
        if (middles(v, u) != middles(y, x)) return false;
    return true;
  };
  cv::Mat3b picture(middles.size());
  cv::Mat noise(middles.size(), CV_32FC3);
  cv::RNG random(scene.seed);
  random.fill(noise, cv::RNG::NORMAL, 0, scene.noise);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      cv::Vec3d sum = middles(y, x);
      if (!is_plain(x, y) && !(scene.before && scene.before(x, y))) {
        sum = {0, 0, 0};
        for (int i = 0; i < rays; ++i)
          for (int j = 0; j < rays; ++j)
            sum += cv::Vec3d(seen_at(x + (j + 0.5) / rays - 0.5, y + (i + 0.5) / rays - 0.5));
        sum /= rays * rays;
      }
      const auto& grain = noise.at<cv::Vec3f>(y, x);
      for (int c = 0; c < 3; ++c) picture(y, x)[c] = cv::saturate_cast<std::uint8_t>(sum[c] + grain[c]);
    }
  return picture;
}

Eigen::Isometry3d looking_at_board(double distance_m, double elevation_rad, double azimuth_rad, double roll_rad) {
  const Vector3d eye = distance_m * Vector3d(std::sin(azimuth_rad) * std::cos(elevation_rad),
                                             -std::cos(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad));
  const Vector3d forward = -eye.normalized();
  const Vector3d right = Vector3d(std::cos(azimuth_rad), std::sin(azimuth_rad), 0);
  const Vector3d down = forward.cross(right);
  Eigen::Isometry3d X_CB = Eigen::Isometry3d::Identity();
  Eigen::Matrix3d R;
  R << right.transpose(), down.transpose(), forward.transpose();
  X_CB.linear() = Eigen::AngleAxisd(roll_rad, Vector3d::UnitZ()) * R;
  X_CB.translation() = -X_CB.linear() * eye;
  return X_CB;
}

Intrinsics camera_720x576(double focal_px) {
  return centred_camera(720, 576, focal_px);
}

double farthest_crossing_px(const BoardGeometry& board, const Intrinsics& camera_a, const Eigen::Isometry3d& a,
                            const Intrinsics& camera_b, const Eigen::Isometry3d& b) {
  double farthest = 0;
  const double D = board.square_size_m, half = 0.5 * board.squares * D;
  for (int i = 0; i <= board.squares; ++i)
    for (int j = 0; j <= board.squares; ++j) {
      const Vector3d p(j * D - half, half - i * D, 0);
      const double distance = (project(camera_a, a * p) - project(camera_b, b * p)).norm();
      if (!(distance <= 1e6)) return 1e6;
      farthest = std::max(farthest, distance);
    }
  return farthest;
}

std::vector<PaintedPiece> start_position(const BoardGeometry& board) {
  std::vector<PaintedPiece> pieces;
  const int rows = board.squares / 2 - 1;
  for (int square = 1; square <= playable_squares(board.squares); ++square) {
    const Cell cell = cell_of_square(square, board.squares);
    if (cell.row < rows) pieces.push_back({cell, cv::Vec3b(28, 32, 45)});
    if (cell.row >= board.squares - rows) pieces.push_back({cell, cv::Vec3b(205, 225, 235)});
  }
  return pieces;
}

}  // namespace counterpart::test
