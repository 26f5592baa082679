#include "tracker_server/pieces/board_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace counterpart {
namespace {

constexpr int widest_half = 3;

// The picture round the board, each pixel the mean of those up to `half` away: about the area that one sample stands
// for.
class Smoothed {
 public:
  Smoothed(const cv::Mat& picture_bgr, const cv::Rect& box) : picture_(picture_bgr), box_(box) {}

  const cv::Mat& at(int half) {
    cv::Mat& smooth = by_half_[static_cast<std::size_t>(half - 1)];
    if (smooth.empty()) cv::blur(picture_(box_), smooth, cv::Size(2 * half + 1, 2 * half + 1));
    return smooth;
  }
  Eigen::Vector2d origin() const { return {box_.x, box_.y}; }

 private:
  const cv::Mat& picture_;
  cv::Rect box_;
  std::array<cv::Mat, widest_half> by_half_;
};

Colour colour_of(const std::uint8_t* bgr) {
  const auto b = static_cast<float>(bgr[0]), g = static_cast<float>(bgr[1]), r = static_cast<float>(bgr[2]);
  return {(r + g + b) * (1.0F / 3), r - g, 0.5F * (r + g) - b};
}

// The corners of all squares in the picture, (squares + 1)^2, by rows.
std::vector<Eigen::Vector2d> corners_of_squares(int squares, const BoardToPixel& to_pixel) {
  std::vector<Eigen::Vector2d> corners;
  for (int row = 0; row <= squares; ++row)
    for (int col = 0; col <= squares; ++col) corners.push_back(to_pixel(col, row));
  return corners;
}

cv::Rect box_round(const std::vector<Eigen::Vector2d>& points, const cv::Size& picture) {
  Eigen::Vector2d low(picture.width, picture.height), high(0, 0);
  for (const Eigen::Vector2d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const cv::Point from(static_cast<int>(std::max(low.x() - widest_half - 1, 0.0)),
                       static_cast<int>(std::max(low.y() - widest_half - 1, 0.0)));
  const cv::Point to(static_cast<int>(std::min<double>(high.x() + widest_half + 2, picture.width)),
                     static_cast<int>(std::min<double>(high.y() + widest_half + 2, picture.height)));
  return cv::Rect(from, to) & cv::Rect({0, 0}, picture);
}

}  // namespace

float length(const Colour& colour) {
  return std::sqrt(colour.light * colour.light + colour.red_green * colour.red_green +
                   colour.warm_cold * colour.warm_cold);
}

BoardView view_board(const cv::Mat& picture_bgr, int squares, const BoardToPixel& to_pixel) {
  BoardView view;
  view.squares = squares;
  view.cells.resize(static_cast<std::size_t>(squares * squares));
  const std::vector<Eigen::Vector2d> corners = corners_of_squares(squares, to_pixel);
  const auto corner = [&](int row, int col) -> const Eigen::Vector2d& {
    return corners[static_cast<std::size_t>(row * (squares + 1) + col)];
  };
  const cv::Rect box = box_round(corners, picture_bgr.size());
  if (box.empty()) return view;
  Smoothed smoothed(picture_bgr, box);
  for (int row = 0; row < squares; ++row)
    for (int col = 0; col < squares; ++col) {
      CellPatch& patch = view.cells[static_cast<std::size_t>(row * squares + col)];
      // Within one square the picture is affine to a good tenth of a sample.
      const Eigen::Vector2d &a = corner(row, col), &b = corner(row, col + 1), &c = corner(row + 1, col),
                            &d = corner(row + 1, col + 1);
      const double sample_px = std::min((b - a).norm(), (c - a).norm()) / patch_side;
      const int half = std::clamp(static_cast<int>(0.5 * sample_px), 1, widest_half);
      const auto inside = [&](const Eigen::Vector2d& p) {
        return p.x() >= half + 1 && p.y() >= half + 1 && p.x() < picture_bgr.cols - half - 1 &&
               p.y() < picture_bgr.rows - half - 1;
      };
      patch.seen = inside(a) && inside(b) && inside(c) && inside(d);
      if (!patch.seen) continue;
      const cv::Mat& smooth = smoothed.at(half);
      const Eigen::Vector2d to_nearest = Eigen::Vector2d(0.5, 0.5) - smoothed.origin();
      patch.samples.resize(patch_side * patch_side);
      Colour* sample = patch.samples.data();
      for (int i = 0; i < patch_side; ++i) {
        const double v = patch_place(i) + 0.5;
        const Eigen::Vector2d along = b - a + v * (d - b - c + a);
        Eigen::Vector2f p = (a + v * (c - a) + to_nearest + along * (patch_place(0) + 0.5)).cast<float>();
        const Eigen::Vector2f step = (along / patch_side).cast<float>();
        for (int j = 0; j < patch_side; ++j, p += step)
          *sample++ = colour_of(smooth.ptr(static_cast<int>(p.y())) + 3 * static_cast<int>(p.x()));
      }
    }
  return view;
}

}  // namespace counterpart
