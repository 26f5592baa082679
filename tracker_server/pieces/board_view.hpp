// The board's squares seen straight from above: a small patch of colours for each.
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/board_geometry.hpp"

namespace counterpart {

// Brightness and two colour differences, grey levels. Distances in it follow what the eye takes for different.
struct Colour {
  float light = 0;      // (R + G + B) / 3
  float red_green = 0;  // R - G
  float warm_cold = 0;  // (R + G) / 2 - B
};

inline Colour operator-(const Colour& a, const Colour& b) {
  return {a.light - b.light, a.red_green - b.red_green, a.warm_cold - b.warm_cold};
}
float length(const Colour& colour);

constexpr int patch_side = 14;  // samples a side of a square

struct CellPatch {
  bool seen = false;            // all of it lies in the picture
  std::vector<Colour> samples;  // patch_side * patch_side, by rows, row 0 on the square's side towards row 0
};

struct BoardView {
  int squares = 0;
  std::vector<CellPatch> cells;  // by rows
  const CellPatch& at(int row, int col) const { return cells[static_cast<std::size_t>(row * squares + col)]; }
};

// Where a sample of a patch lies in its square, from its centre, in squares: -0.5 .. 0.5.
constexpr double patch_place(int index) {
  return (index + 0.5) / patch_side - 0.5;
}

// to_pixel takes a point of the board, in squares (column, row) from the corner of row 0, column 0, to the picture.
using BoardToPixel = std::function<Eigen::Vector2d(double column, double row)>;

BoardView view_board(const cv::Mat& picture_bgr, int squares, const BoardToPixel& to_pixel);

}  // namespace counterpart
