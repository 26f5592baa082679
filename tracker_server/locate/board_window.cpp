#include "tracker_server/locate/board_window.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

namespace counterpart {
namespace {

constexpr float outside_picture = -1e9F;

// Grey level at a lattice point; `outside_picture` outside the picture or behind the camera.
class LatticeSampler {
 public:
  LatticeSampler(const cv::Mat1b& grey, const Eigen::Matrix3d& H, double centre_u, double centre_v)
      : grey_(grey), H_(H) {
    if ((H * Eigen::Vector3d(centre_u, centre_v, 1)).z() < 0) H_ = -H;
  }

  float operator()(double u, double v) const {
    const Eigen::Vector3d h = H_ * Eigen::Vector3d(u, v, 1);
    if (!(h.z() > 0)) return outside_picture;
    const double x = h.x() / h.z(), y = h.y() / h.z();
    if (!(x >= 0 && y >= 0 && x < grey_.cols - 1 && y < grey_.rows - 1)) return outside_picture;
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const float fx = static_cast<float>(x - column), fy = static_cast<float>(y - row);
    const std::uint8_t* p = grey_.ptr(row) + column;
    const std::uint8_t* q = grey_.ptr(row + 1) + column;
    return (1 - fy) * (static_cast<float>(p[0]) + fx * static_cast<float>(p[1] - p[0])) +
           fy * (static_cast<float>(q[0]) + fx * static_cast<float>(q[1] - q[0]));
  }

 private:
  const cv::Mat1b& grey_;
  Eigen::Matrix3d H_;
};

// The step across the edge between two squares, positive if the first square of the lattice pattern, (0, 0) and its
// like, is the lighter. Seven places along the edge, of which the third clearest counts: a round piece spoils the
// middle three, and its height may lean over one more.
float edge_step(const LatticeSampler& sample, int u, int v, bool along_v) {
  constexpr std::array places = {0.10, 0.18, 0.26, 0.5, 0.74, 0.82, 0.90};
  constexpr double aside = 0.16;
  std::array<float, places.size()> steps;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const float after = along_v ? sample(u + aside, v + places[i]) : sample(u + places[i], v + aside);
    const float before = along_v ? sample(u - aside, v + places[i]) : sample(u + places[i], v - aside);
    if (after == outside_picture || before == outside_picture) return outside_picture;
    steps[i] = after - before;
  }
  std::sort(steps.begin(), steps.end());
  const float step = steps[3] > 0 ? steps[4] : steps[2];
  return (u + v) % 2 == 0 ? step : -step;
}

// Steps across all edges of a range of squares, by the square that lies after the edge.
class Steps {
 public:
  Steps(const LatticeSampler& sample, int u0, int u1, int v0, int v1)
      : u0_(u0), v0_(v0), columns_(u1 - u0 + 1), rows_(v1 - v0 + 1) {
    const auto cells = static_cast<std::size_t>(columns_ * rows_);
    left_.resize(cells);
    top_.resize(cells);
    for (int v = v0; v <= v1; ++v)
      for (int u = u0; u <= u1; ++u) {
        left_[index(u, v)] = edge_step(sample, u, v, true);
        top_[index(u, v)] = edge_step(sample, u, v, false);
      }
  }
  bool inside(int u, int v) const { return u >= u0_ && v >= v0_ && u < u0_ + columns_ && v < v0_ + rows_; }
  float left(int u, int v) const { return inside(u, v) ? left_[index(u, v)] : outside_picture; }
  float top(int u, int v) const { return inside(u, v) ? top_[index(u, v)] : outside_picture; }

 private:
  std::size_t index(int u, int v) const { return static_cast<std::size_t>((v - v0_) * columns_ + u - u0_); }
  int u0_, v0_, columns_, rows_;
  std::vector<float> left_, top_;
};

struct Evidence {
  double sum = 0;
  int count = 0;
  double mean() const { return count == 0 ? 0 : sum / count; }
};

struct Measure {
  float typical;  // signed: positive if the lattice's (0, 0) is light
  void add(Evidence& evidence, float step) const {
    if (step == outside_picture) return;
    evidence.sum += std::clamp(step / typical, -1.0F, 1.0F);
    ++evidence.count;
  }
};

BoardWindow measure(const Steps& steps, const Measure& m, int n, int u0, int v0) {
  BoardWindow window;
  window.u = u0;
  window.v = v0;
  Evidence inside;
  for (int v = v0; v < v0 + n; ++v)
    for (int u = u0 + 1; u < u0 + n; ++u) m.add(inside, steps.left(u, v));
  for (int v = v0 + 1; v < v0 + n; ++v)
    for (int u = u0; u < u0 + n; ++u) m.add(inside, steps.top(u, v));
  window.support = inside.mean();
  window.seen = inside.count / (2.0 * n * (n - 1));

  // Along the outermost squares inside, and along the first squares outside.
  std::array<Evidence, 4> rim, beyond;
  for (int i = 1; i < n; ++i) {
    m.add(rim[0], steps.left(u0 + i, v0));
    m.add(rim[1], steps.left(u0 + i, v0 + n - 1));
    m.add(rim[2], steps.top(u0, v0 + i));
    m.add(rim[3], steps.top(u0 + n - 1, v0 + i));
    m.add(beyond[0], steps.left(u0 + i, v0 - 1));
    m.add(beyond[1], steps.left(u0 + i, v0 + n));
    m.add(beyond[2], steps.top(u0 - 1, v0 + i));
    m.add(beyond[3], steps.top(u0 + n, v0 + i));
  }
  window.weakest_side = 1;
  for (const auto& side : rim)
    window.weakest_side = std::min(window.weakest_side, side.count < n / 2 ? 0 : side.mean());
  for (const auto& side : beyond)
    if (side.count >= n / 2) window.beyond = std::max(window.beyond, side.mean());
  window.first_light = ((u0 + v0) % 2 == 0) == (m.typical > 0);
  window.contrast = std::abs(m.typical);
  return window;
}

// What a window is worth: all its evidence, less what the pattern shows beyond it.
double worth(const BoardWindow& window, int n) {
  return 2.0 * n * (n - 1) * window.seen * window.support - (n - 1) * std::max(0.0, window.beyond);
}

float typical_step(const Steps& steps, int u0, int u1, int v0, int v1) {
  std::vector<float> seen;
  double sum = 0;
  for (int v = v0; v < v1; ++v)
    for (int u = u0; u < u1; ++u)
      for (float step : {steps.left(u, v), steps.top(u, v)})
        if (step != outside_picture) {
          seen.push_back(std::abs(step));
          sum += step;
        }
  if (seen.empty()) return 0;
  // Most edges between known lattice points are real ones: their median is the pattern's contrast.
  std::nth_element(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2), seen.end());
  const float median = std::max(seen[seen.size() / 2], 1.0F);
  return sum < 0 ? -median : median;
}

}  // namespace

std::optional<BoardWindow> find_board_window(const cv::Mat1b& grey, const Eigen::Matrix3d& H, int n, int u0, int u1,
                                             int v0, int v1) {
  const LatticeSampler sample(grey, H, 0.5 * (u0 + u1), 0.5 * (v0 + v1));
  const Steps steps(sample, u0 - n, u1 + n, v0 - n, v1 + n);
  const Measure m{typical_step(steps, u0, u1, v0, v1)};
  if (m.typical == 0) return std::nullopt;

  std::optional<BoardWindow> best;
  double best_worth = -1e9, second_worth = -1e9;
  // The window holds the middle of the known points: they are its inner corners.
  const int middle_u = (u0 + u1) / 2, middle_v = (v0 + v1) / 2;
  for (int v = middle_v - n + 1; v < middle_v; ++v)
    for (int u = middle_u - n + 1; u < middle_u; ++u) {
      // One corner may lie outside the picture: the lines that lead to it still tell where.
      int corners_seen = 0;
      for (int du : {0, n})
        for (int dv : {0, n}) corners_seen += sample(u + du, v + dv) != outside_picture;
      if (corners_seen < 3) continue;
      const BoardWindow window = measure(steps, m, n, u, v);
      const double value = worth(window, n);
      if (value > best_worth) {
        second_worth = best_worth;
        best_worth = value;
        best = window;
      } else {
        second_worth = std::max(second_worth, value);
      }
    }
  if (best) best->margin = (best_worth - second_worth) / (2.0 * n - 1);
  return best;
}

BoardWindow judge_board_window(const cv::Mat1b& grey, const Eigen::Matrix3d& H, int n, int u, int v) {
  const LatticeSampler sample(grey, H, u + 0.5 * n, v + 0.5 * n);
  const Steps steps(sample, u - 1, u + n, v - 1, v + n);
  const Measure m{typical_step(steps, u + 1, u + n, v + 1, v + n)};
  if (m.typical == 0) return {};
  return measure(steps, m, n, u, v);
}

}  // namespace counterpart
