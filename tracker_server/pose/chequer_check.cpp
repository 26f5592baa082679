#include "tracker_server/pose/chequer_check.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

constexpr float unseen = -1e9F;
constexpr double is_missing = 0.25;

class BoardSampler {
 public:
  BoardSampler(const cv::Mat1b& grey, const BoardGeometry& board, const Intrinsics& camera,
               const Eigen::Isometry3d& X_CB)
      : grey_(grey), camera_(camera) {
    // (row, col) in squares from the corner of row 0, column 0 to the camera frame.
    const double D = board.square_size_m, half = 0.5 * board.squares * D;
    origin_ = X_CB * Eigen::Vector3d(-half, half, 0);
    down_ = X_CB.linear() * Eigen::Vector3d(0, -D, 0);
    right_ = X_CB.linear() * Eigen::Vector3d(D, 0, 0);
  }

  float operator()(double row, double col) const {
    const Eigen::Vector3d p_C = origin_ + row * down_ + col * right_;
    if (!(p_C.z() > 1e-6)) return unseen;
    const Eigen::Vector2d p = project(camera_, p_C);
    if (!(p.x() >= 0 && p.y() >= 0 && p.x() < grey_.cols - 1 && p.y() < grey_.rows - 1)) return unseen;
    const int x = static_cast<int>(p.x()), y = static_cast<int>(p.y());
    const float fx = static_cast<float>(p.x() - x), fy = static_cast<float>(p.y() - y);
    const std::uint8_t* a = grey_.ptr(y) + x;
    const std::uint8_t* b = grey_.ptr(y + 1) + x;
    return (1 - fy) * (static_cast<float>(a[0]) + fx * static_cast<float>(a[1] - a[0])) +
           fy * (static_cast<float>(b[0]) + fx * static_cast<float>(b[1] - b[0]));
  }

  // Step from the square before to the square (row, col), near the line's two ends where round pieces do not reach.
  // The one nearer to zero: a thing that covers one end must not count.
  float step(int row, int col, bool from_left) const {
    constexpr double aside = 0.16;
    float least = unseen;
    for (double place : {0.14, 0.86}) {
      const float after = from_left ? (*this)(row + place, col + aside) : (*this)(row + aside, col + place);
      const float before = from_left ? (*this)(row + place, col - aside) : (*this)(row - aside, col + place);
      if (after == unseen || before == unseen) return unseen;
      const float value = after - before;
      if (least == unseen || std::abs(value) < std::abs(least)) least = value;
    }
    return least;
  }

 private:
  const cv::Mat1b& grey_;
  const Intrinsics& camera_;
  Eigen::Vector3d origin_, down_, right_;
};

struct Mean {
  double sum = 0;
  int count = 0;
  double value() const { return count == 0 ? 0 : sum / count; }
};

}  // namespace

bool ChequerCheck::goes_on(std::size_t side) const {
  constexpr double follows = 0.5;
  return beyond[side] > follows && rim[side ^ 1U] < is_missing;
}

bool ChequerCheck::may_go_on(std::size_t side) const {
  return goes_on(side) || (!beyond_seen[side] && rim_seen[side ^ 1U] && rim[side ^ 1U] < is_missing);
}

bool ChequerCheck::may_be_shifted() const {
  for (std::size_t side = 0; side < 4; ++side)
    if (may_go_on(side)) return true;
  return false;
}

std::vector<Eigen::Vector2i> ChequerCheck::ways_back() const {
  const Eigen::Vector2i way((may_go_on(3) ? 1 : 0) - (may_go_on(2) ? 1 : 0),
                            (may_go_on(0) ? 1 : 0) - (may_go_on(1) ? 1 : 0));
  if (way.isZero()) return {};
  if (way.x() != 0 && way.y() != 0) return {way};
  // One square along alone would change every colour.
  const Eigen::Vector2i aside(way.y(), way.x());
  return {2 * way, way + aside, way - aside};
}

ChequerCheck check_chequer(const cv::Mat1b& grey, const BoardGeometry& board, const Intrinsics& camera,
                           const Eigen::Isometry3d& X_CB, double typical_contrast) {
  const int n = board.squares;
  const BoardSampler sample(grey, board, camera, X_CB);
  const auto sign = [&](int row, int col) {
    const bool played = (row + col) % 2 != 0;
    return played == (board.played_on == SquareColour::light) ? 1.0F : -1.0F;
  };
  // Every step between two squares, rows -1 and n and the like included, signed so that a board gives positive ones.
  struct Step {
    int row, col;
    bool from_left;
    float value;
  };
  std::vector<Step> steps;
  steps.reserve(static_cast<std::size_t>(2 * n * n));
  std::vector<float> inside;
  const auto look = [&](int row, int col, bool from_left) {
    const float value = sample.step(row, col, from_left);
    if (value == unseen) return;
    steps.push_back({row, col, from_left, sign(row, col) * value});
    if (row >= 0 && row < n && col >= 0 && col < n) inside.push_back(std::abs(value));
  };
  for (int row = -1; row <= n; ++row)
    for (int col = 1; col < n; ++col) look(row, col, true);
  for (int col = -1; col <= n; ++col)
    for (int row = 1; row < n; ++row) look(row, col, false);

  ChequerCheck check;
  check.looked_at = static_cast<int>(inside.size());
  if (inside.empty()) return check;
  std::nth_element(inside.begin(), inside.begin() + static_cast<std::ptrdiff_t>(inside.size() / 2), inside.end());
  check.contrast = inside[inside.size() / 2];
  const double typical = std::max(3.0, typical_contrast > 0 ? typical_contrast : check.contrast);

  constexpr double clearly = 0.5;
  constexpr int fewest_beside = 3;
  Mean support, contradicted;
  std::array<Mean, 4> rim, beyond;
  std::array<int, 4> beyond_looked_at{};
  // Of the line of squares just inside each side and of the one just outside it, by place along the side.
  std::array<std::vector<double>, 4> inner, outer;
  for (auto* lines : {&inner, &outer}) lines->fill(std::vector<double>(static_cast<std::size_t>(n), 0.0));
  const auto add = [](Mean& mean, double value) {
    mean.sum += value;
    ++mean.count;
  };
  for (const Step& s : steps) {
    const double value = std::clamp(s.value / typical, -1.0, 1.0);
    const int line = s.from_left ? s.row : s.col;  // which line of squares the pair lies in
    const auto along = static_cast<std::size_t>(s.from_left ? s.col : s.row);
    const std::size_t first = s.from_left ? 0 : 2;
    if (line == -1 || line == n) {
      const std::size_t side = line == -1 ? first : first + 1;
      outer[side][along] = value;
      ++beyond_looked_at[side];
    } else {
      add(support, value);
      add(contradicted, value < -clearly ? 1 : 0);
    }
    if (line == 0) {
      add(rim[first], value);
      inner[first][along] = value;
    }
    if (line == n - 1) {
      add(rim[first + 1], value);
      inner[first + 1][along] = value;
    }
  }
  check.support = support.value();
  check.contradicted = contradicted.value();
  for (std::size_t side = 0; side < 4; ++side) {
    check.rim[side] = rim[side].value();
    check.rim_seen[side] = rim[side].count >= n / 2;
    check.beyond_seen[side] = beyond_looked_at[side] >= n / 2;
    // Only where squares are seen inside can it be said whether they go on outside.
    for (std::size_t i = 0; i < inner[side].size(); ++i)
      if (inner[side][i] > clearly) add(beyond[side], outer[side][i]);
    check.beyond[side] = beyond[side].count < fewest_beside ? 0 : beyond[side].value();
  }
  return check;
}

}  // namespace counterpart
