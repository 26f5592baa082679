#include "tracker_server/pieces/cover.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace counterpart {
namespace {

// Squares that are never played on are always empty: what fills one of them is a hand or a thing, not a piece.
std::vector<bool> covered_cells(const std::vector<CellLook>& looks, int squares) {
  std::vector<bool> covered(looks.size(), false);
  const auto index = [&](int row, int col) { return static_cast<std::size_t>(row * squares + col); };
  for (int row = 0; row < squares; ++row)
    for (int col = 0; col < squares; ++col)
      if ((row + col) % 2 == 0 && looks[index(row, col)].seen)
        covered[index(row, col)] = looks[index(row, col)].full > covered_share;
  // A playable square is covered if two of those round it are.
  for (int row = 0; row < squares; ++row)
    for (int col = 0; col < squares; ++col) {
      if ((row + col) % 2 == 0) continue;
      int beside = 0;
      for (const auto& [dr, dc] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        const int r = row + dr, c = col + dc;
        if (r >= 0 && c >= 0 && r < squares && c < squares) beside += covered[index(r, c)];
      }
      covered[index(row, col)] = beside >= 2;
    }
  return covered;
}

bool beside_covered(const std::vector<bool>& covered, int squares, int row, int col) {
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, squares - 1); ++r)
    for (int c = std::max(col - 1, 0); c <= std::min(col + 1, squares - 1); ++c)
      if (covered[static_cast<std::size_t>(r * squares + c)]) return true;
  return false;
}

// Less light of the same hue: what throws a shadow is elsewhere.
bool in_shadow(const Colour& sample, const Colour& usual) {
  constexpr float deepest = 0.3F, same_hue = 12;
  if (!(sample.light < usual.light) || sample.light < deepest * usual.light) return false;
  const float dimmed = sample.light / usual.light;
  return std::hypot(sample.red_green - dimmed * usual.red_green, sample.warm_cold - dimmed * usual.warm_cold) <
         same_hue;
}

// The samples of one square that differ from the empty board.
void mark(const CellPatch& patch, const GroundLook& ground, cv::Mat1b part) {
  for (int i = 0; i < patch_side; ++i)
    for (int j = 0; j < patch_side; ++j) {
      const Colour& sample = patch.samples[static_cast<std::size_t>(i * patch_side + j)];
      if (length(sample - ground.usual) > ground.tolerance && !in_shadow(sample, ground.usual)) part(i, j) = 255;
    }
}

}  // namespace

Cover find_cover(const BoardView& view, const std::vector<CellLook>& looks, const std::vector<bool>& was_empty,
                 const GroundTolerance& most) {
  const int n = view.squares;
  Cover cover;
  cover.cells = covered_cells(looks, n);
  cover.any = std::find(cover.cells.begin(), cover.cells.end(), true) != cover.cells.end();
  cover.samples = cv::Mat1b(n * patch_side, n * patch_side, std::uint8_t{0});
  if (!cover.any) return cover;
  const std::array<GroundLook, 2> grounds = ground_looks(view, looks, most);
  for (int row = 0; row < n; ++row)
    for (int col = 0; col < n; ++col) {
      const auto i = static_cast<std::size_t>(row * n + col);
      // Beside what is covered, only squares without a piece.
      const bool no_piece = (row + col) % 2 == 0 || was_empty[i];
      const bool concerned = cover.cells[i] || (no_piece && beside_covered(cover.cells, n, row, col));
      if (!concerned || !view.cells[i].seen) continue;
      const cv::Rect place(col * patch_side, row * patch_side, patch_side, patch_side);
      mark(view.cells[i], grounds[static_cast<std::size_t>(row + col) % 2], cover.samples(place));
    }
  // Specks are noise; and a hand has no holes, though on the squares of one colour it may look like the board itself.
  const cv::Mat speck = cv::getStructuringElement(cv::MORPH_ELLIPSE, {3, 3});
  const cv::Mat square = cv::getStructuringElement(cv::MORPH_ELLIPSE, {patch_side + 3, patch_side + 3});
  cv::morphologyEx(cover.samples, cover.samples, cv::MORPH_OPEN, speck);
  cv::morphologyEx(cover.samples, cover.samples, cv::MORPH_CLOSE, square);
  return cover;
}

}  // namespace counterpart
