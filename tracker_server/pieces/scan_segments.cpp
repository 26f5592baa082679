#include "tracker_server/pieces/scan_segments.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "protocol/vocabulary/board_geometry.hpp"

namespace counterpart {

std::vector<double> scan_values(const cv::Mat1b& grey, int squares, const BoardToPixel& to_pixel) {
  std::vector<double> values(static_cast<std::size_t>(squares * squares), -1);
  for (int row = 0; row < squares; ++row)
    for (int col = 0; col < squares; ++col) {
      const Eigen::Vector2d a = to_pixel(col, row + 0.5), b = to_pixel(col + 1, row + 0.5);
      const int steps = std::clamp(static_cast<int>((b - a).norm()), 4, 200);
      double sum = 0;
      bool inside = true;
      for (int i = 0; i < steps && inside; ++i) {
        const Eigen::Vector2d p = a + (i + 0.5) / steps * (b - a);
        const int x = static_cast<int>(std::lround(p.x())), y = static_cast<int>(std::lround(p.y()));
        inside = x >= 0 && y >= 0 && x < grey.cols && y < grey.rows;
        if (inside) sum += grey(y, x);
      }
      if (inside) values[static_cast<std::size_t>(row * squares + col)] = sum / steps;
    }
  return values;
}

std::optional<ScanRule> scan_rule(const std::vector<double>& values, int squares, const std::string& expected,
                                  int parity) {
  std::vector<double> playable, empty, taken;
  for (int row = 0; row < squares; ++row)
    for (int col = 0; col < squares; ++col) {
      const double value = values[static_cast<std::size_t>(row * squares + col)];
      if ((row + col) % 2 != parity || value < 0) continue;
      playable.push_back(value);
      const auto square = square_of_cell({row, col}, squares);
      const std::size_t i = square ? static_cast<std::size_t>(*square - 1) : expected.size();
      if (i < expected.size()) (expected[i] == 'e' ? empty : taken).push_back(value);
    }
  const auto median = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  if (empty.size() >= 3 && taken.size() >= 3) {
    const double of_empty = median(empty), of_taken = median(taken);
    return ScanRule{0.5 * (of_empty + of_taken), of_taken < of_empty, true};
  }

  // Without a known set-up: the split that leaves the two groups tightest (Otsu).
  if (playable.size() < 8) return std::nullopt;
  std::sort(playable.begin(), playable.end());
  const double total = std::accumulate(playable.begin(), playable.end(), 0.0);
  double below = 0, best = -1, threshold = 0;
  for (std::size_t i = 1; i < playable.size(); ++i) {
    below += playable[i - 1];
    const double n0 = static_cast<double>(i), n1 = static_cast<double>(playable.size() - i);
    const double gap = (total - below) / n1 - below / n0;
    const double between = n0 * n1 * gap * gap;
    if (between > best) {
      best = between;
      threshold = 0.5 * (playable[i - 1] + playable[i]);
    }
  }
  return ScanRule{threshold, true, false};
}

std::vector<CellSight> read_scan(const std::vector<double>& values, int squares, double threshold, bool pieces_dark,
                                 int parity) {
  std::vector<CellSight> cells(values.size());
  for (int row = 0; row < squares; ++row)
    for (int col = 0; col < squares; ++col) {
      const auto i = static_cast<std::size_t>(row * squares + col);
      if (values[i] < 0) continue;
      const bool playable = (row + col) % 2 == parity;
      const bool piece = playable && (values[i] <= threshold) == pieces_dark;
      cells[i].reading = piece ? (pieces_dark ? CellReading::dark : CellReading::light) : CellReading::empty;
      cells[i].confidence = static_cast<float>(std::min(1.0, std::abs(values[i] - threshold) / 30));
    }
  return cells;
}

}  // namespace counterpart
