#include "tracker_server/locate/locate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "tracker_server/locate/board_window.hpp"
#include "tracker_server/locate/grid_fit.hpp"
#include "tracker_server/locate/lattice.hpp"

namespace counterpart {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

// What a window must show to be called a board. Pieces and hands cost support, hence so much below 1; look-alikes one
// square along lose a whole side, and parts of larger patterns go on beyond.
constexpr double least_window_support = 0.5;
constexpr double least_side = 0.25;
constexpr double most_beyond = 0.45;
constexpr double least_margin = 0.2;

bool convincing(const BoardWindow& window) {
  return window.support >= least_window_support && window.weakest_side >= least_side && window.beyond <= most_beyond &&
         window.contrast >= 6;
}

// Moves the origin of squares to lattice point (u, v).
Matrix3d from_corner(const Matrix3d& H, int u, int v) {
  Matrix3d shift = Matrix3d::Identity();
  shift(0, 2) = u;
  shift(1, 2) = v;
  return H * shift;
}

// Turns the squares so that corner 0 is the one nearest to the picture's top left.
void order_corners(LocatedBoard& board, int n) {
  Matrix3d quarter;  // the square of corners starts one corner further on
  quarter << 0, -1, n, 1, 0, 0, 0, 0, 1;
  Matrix3d best = board.H;
  bool best_light = board.first_light;
  double least = std::numeric_limits<double>::max();
  Matrix3d H = board.H;
  bool light = board.first_light;
  for (int turn = 0; turn < 4; ++turn) {
    const Vector2d corner = apply(H, 0, 0);
    if (corner.sum() < least) {
      least = corner.sum();
      best = H;
      best_light = light;
    }
    H = (H * quarter).eval();
    light = n % 2 == 0 ? !light : light;
  }
  board.H = best;
  board.first_light = best_light;
}

// Pictures measured in pixels of the working size; returns the homography in those of the full one.
Matrix3d scaled_up(const Matrix3d& H, double factor) {
  Matrix3d scale;
  scale << factor, 0, 0.5 * (factor - 1), 0, factor, 0.5 * (factor - 1), 0, 0, 1;
  return scale * H;
}

std::optional<LocatedBoard> locate_at(const cv::Mat1b& grey, const Pyramid& full, int n, double factor) {
  const std::vector<Saddle> saddles = find_saddles(grey, 10, 700);
  const std::size_t fewest = static_cast<std::size_t>((n - 1) * (n - 1) / 5);
  for (const Lattice& lattice : grow_lattices(saddles, std::max<std::size_t>(fewest, 8), 3)) {
    int u0 = 99, u1 = -99, v0 = 99, v1 = -99;
    for (const auto& p : lattice.points) {
      u0 = std::min(u0, p.u);
      u1 = std::max(u1, p.u);
      v0 = std::min(v0, p.v);
      v1 = std::max(v1, p.v);
    }
    const auto window = find_board_window(grey, lattice.H, n, u0, u1, v0, v1);
    if (!window || window->support < 0.8 * least_window_support) continue;
    const Matrix3d start = scaled_up(from_corner(lattice.H, window->u, window->v), factor);
    const GridFit fit = fit_grid(full, start, n, window->first_light);
    // Looked at again with the exact grid: over the whole neighbourhood, since the outermost rows decide.
    Matrix3d down = scaled_up(Matrix3d::Identity(), factor).inverse() * fit.H;
    const auto again = find_board_window(grey, down, n, 1, n - 1, 1, n - 1);
    if (!again || again->margin < least_margin || !convincing(*again)) continue;
    LocatedBoard board{from_corner(fit.H, again->u, again->v), again->first_light, again->support, again->contrast};
    if (again->u != 0 || again->v != 0) board.H = fit_grid(full, board.H, n, board.first_light).H;
    order_corners(board, n);
    return board;
  }
  return std::nullopt;
}

}  // namespace

std::array<Vector2d, 4> LocatedBoard::corners(int n) const {
  return {apply(H, 0, 0), apply(H, n, 0), apply(H, n, n), apply(H, 0, n)};
}

Vector2d LocatedBoard::to_pixel(double column, double row) const {
  return apply(H, column, row);
}

std::optional<LocatedBoard> locate_board(const cv::Mat& picture, int n) {
  const Pyramid full = build_pyramid(picture, 4);
  const cv::Mat1b& grey = full.levels.front();
  const int longest = std::max(grey.cols, grey.rows);
  double last = 0;
  for (int side : {800, 1600, 480}) {
    const double factor = std::max(1.0, static_cast<double>(longest) / side);
    if (factor == last) continue;
    last = factor;
    cv::Mat1b working = grey;
    if (factor > 1) cv::resize(grey, working, cv::Size(), 1 / factor, 1 / factor, cv::INTER_AREA);
    if (auto board = locate_at(working, full, n, static_cast<double>(grey.cols) / working.cols)) return board;
  }
  return std::nullopt;
}

std::optional<LocatedBoard> board_at_corners(const Pyramid& pyramid, const std::array<Vector2d, 4>& corners, int n) {
  // Any order in, clockwise in the picture out.
  Vector2d centre = Vector2d::Zero();
  for (const auto& corner : corners) {
    if (!corner.allFinite()) return std::nullopt;
    centre += 0.25 * corner;
  }
  std::array<Vector2d, 4> ordered = corners;
  std::sort(ordered.begin(), ordered.end(), [&](const Vector2d& a, const Vector2d& b) {
    return std::atan2(a.y() - centre.y(), a.x() - centre.x()) < std::atan2(b.y() - centre.y(), b.x() - centre.x());
  });
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d a = ordered[(i + 1) % 4] - ordered[i], b = ordered[(i + 2) % 4] - ordered[(i + 1) % 4];
    if (!(a.x() * b.y() - a.y() * b.x() > 1)) return std::nullopt;  // not convex, or too small
  }
  const double side = n;
  LocatedBoard board;
  board.H = fit_homography({{0, 0}, {side, 0}, {side, side}, {0, side}}, {ordered.begin(), ordered.end()});
  BoardWindow window = judge_board_window(pyramid.levels.front(), board.H, n, 0, 0);
  board.first_light = window.first_light;
  const GridFit fit = fit_grid(pyramid, board.H, n, board.first_light);
  window = judge_board_window(pyramid.levels.front(), fit.H, n, 0, 0);
  board.support = window.support;
  board.contrast = window.contrast;
  // The corners given are trusted to be outer ones: a fit that leaves them is one square off.
  double moved = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::array<Vector2d, 4> fitted = LocatedBoard{fit.H}.corners(n);
    moved = std::max(moved, (fitted[i] - ordered[i]).norm());
  }
  if (window.support > 0.4 && moved < 0.6 * (ordered[2] - ordered[0]).norm() / n) board.H = fit.H;
  order_corners(board, n);
  return board;
}

}  // namespace counterpart
