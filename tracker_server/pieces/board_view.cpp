#include "tracker_server/pieces/board_view.hpp"

#include <cmath>

namespace counterpart {
namespace {

// Mean of the pixels round a point, over about the area that one sample stands for.
Colour look(const cv::Mat& picture, const Eigen::Vector2d& p, int half) {
  const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
  int blue = 0, green = 0, red = 0, count = 0;
  for (int row = y - half; row <= y + half; ++row) {
    const std::uint8_t* pixel = picture.ptr(row) + 3 * (x - half);
    for (int col = 0; col <= 2 * half; ++col, pixel += 3) {
      blue += pixel[0];
      green += pixel[1];
      red += pixel[2];
      ++count;
    }
  }
  const float scale = 1.0F / static_cast<float>(count);
  const float b = static_cast<float>(blue) * scale, g = static_cast<float>(green) * scale,
              r = static_cast<float>(red) * scale;
  return {(r + g + b) / 3, r - g, 0.5F * (r + g) - b};
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
  for (int row = 0; row < squares; ++row)
    for (int col = 0; col < squares; ++col) {
      CellPatch& patch = view.cells[static_cast<std::size_t>(row * squares + col)];
      // Within one square the picture is affine to a good tenth of a sample.
      const Eigen::Vector2d a = to_pixel(col, row), b = to_pixel(col + 1, row), c = to_pixel(col, row + 1),
                            d = to_pixel(col + 1, row + 1);
      const double sample_px = std::min((b - a).norm(), (c - a).norm()) / patch_side;
      const int half = std::min(3, static_cast<int>(0.5 * sample_px));
      const auto inside = [&](const Eigen::Vector2d& p) {
        return p.x() >= half + 1 && p.y() >= half + 1 && p.x() < picture_bgr.cols - half - 1 &&
               p.y() < picture_bgr.rows - half - 1;
      };
      patch.seen = inside(a) && inside(b) && inside(c) && inside(d);
      if (!patch.seen) continue;
      patch.samples.reserve(patch_side * patch_side);
      for (int i = 0; i < patch_side; ++i) {
        const double v = patch_place(i) + 0.5;
        const Eigen::Vector2d left = a + v * (c - a), right = b + v * (d - b);
        for (int j = 0; j < patch_side; ++j)
          patch.samples.push_back(look(picture_bgr, left + (patch_place(j) + 0.5) * (right - left), half));
      }
    }
  return view;
}

}  // namespace counterpart
