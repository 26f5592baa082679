#include "tracker_server/pose/reference_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "tracker_server/pose/fit.hpp"
#include "tracker_server/pose/normal_equations.hpp"
#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix8 = Eigen::Matrix<double, 8, 8>;
using Vector8 = Eigen::Matrix<double, 8, 1>;

constexpr int points_a_square = 4;   // along a side
constexpr double rim_squares = 0.4;  // round the playing surface, looked at, too: the border
constexpr int exposures = 9;         // of which a smeared picture is made
constexpr std::size_t fewest_in_both = 150;
constexpr double least_depth_m = 1e-3;

// Brightness that agrees within so many standard deviations (Tukey), and the least of those: noise, light.
constexpr double agrees = 4.7, least_sigma = 3;

struct Round {
  int level, iterations;
};
constexpr Round rounds[] = {{2, 5}, {1, 4}, {1, 4}};

// Bilinear; false outside.
inline bool sample(const cv::Mat1b& grey, double x, double y, float& value) {
  if (!(x >= 0 && y >= 0 && x < grey.cols - 1 && y < grey.rows - 1)) return false;
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const auto fx = static_cast<float>(x - column), fy = static_cast<float>(y - row);
  const std::uint8_t* a = grey.ptr(row) + column;
  const std::uint8_t* b = grey.ptr(row + 1) + column;
  const float top = static_cast<float>(a[0]) + fx * static_cast<float>(a[1] - a[0]);
  const float low = static_cast<float>(b[0]) + fx * static_cast<float>(b[1] - b[0]);
  value = top + fy * (low - top);
  return true;
}

Vector2d to_level(const Vector2d& pixel, int level) {
  const double scale = 1.0 / (1 << level);
  return {(pixel.x() + 0.5) * scale - 0.5, (pixel.y() + 0.5) * scale - 0.5};
}

// From points of the board's plane (x, y, 1) to points of the picture's plane at distance 1, up to scale.
Matrix3d plane_of(const Isometry3d& X_CB) {
  Matrix3d H;
  H << X_CB.linear().col(0), X_CB.linear().col(1), X_CB.translation();
  return H;
}

// What is to be added to a pose for `moved`, a frame.
struct Step {
  Vector3d translation, rotation;
};

Step step_between(const Isometry3d& a, const Isometry3d& b) {
  const Eigen::AngleAxisd turn(b.linear() * a.linear().transpose());
  return {b.translation() - a.translation(), turn.angle() * turn.axis()};
}

// The poses during the exposure, evenly in time, with X_CB in its middle.
std::vector<Isometry3d> exposed_poses(const Isometry3d& X_CB, const MotionBlur& blur) {
  const Step last = step_between(blur.X_CB_before, blur.X_CB_now);
  const Step first = blur.X_CB_earlier ? step_between(*blur.X_CB_earlier, blur.X_CB_before) : last;
  const auto way = [](const Vector3d& a, const Vector3d& b, double time) -> Vector3d {
    const Vector3d bend = b - a;
    return time * (b + 0.5 * bend) + 0.5 * time * time * bend;
  };
  std::vector<Isometry3d> poses;
  for (int k = 0; k < exposures; ++k) {
    const double time = blur.shutter_share * ((k + 0.5) / exposures - 0.5);
    poses.push_back(
        moved(X_CB, way(first.translation, last.translation, time), way(first.rotation, last.rotation, time)));
  }
  return poses;
}

struct BoardPoint {
  Vector3d p_B;
  float expected;  // grey level
};

// What the picture should show at each point of the board, by the reference view and the blur.
std::vector<BoardPoint> expect(const ReferenceView& reference, const BoardGeometry& board, const Isometry3d& X_CB,
                               const MotionBlur& blur, int level) {
  const cv::Mat1b& grey = reference.pyramid.levels[static_cast<std::size_t>(level)];
  std::vector<Matrix3d> back;  // to the plane of the board, at moments of the exposure
  for (const Isometry3d& X : exposed_poses(X_CB, blur)) back.push_back(plane_of(X).inverse());
  std::vector<BoardPoint> points;
  const double D = board.square_size_m;
  const int reach = static_cast<int>((0.5 * board.squares + rim_squares) * points_a_square);
  for (int row = -reach; row <= reach; ++row)
    for (int col = -reach; col <= reach; ++col) {
      const Vector3d p_B((col + 0.5) * D / points_a_square, (row + 0.5) * D / points_a_square, 0);
      const Vector3d ray = X_CB * p_B;
      float sum = 0;
      bool seen = ray.z() > least_depth_m;
      for (int k = 0; seen && k < exposures; ++k) {
        const Vector3d q = back[static_cast<std::size_t>(k)] * ray;
        const Vector3d q_C = reference.X_CB * Vector3d(q.x() / q.z(), q.y() / q.z(), 0);
        float value = 0;
        seen = q_C.z() > least_depth_m;
        if (!seen) break;
        const Vector2d at = to_level(project(reference.camera, q_C), level);
        seen = sample(grey, at.x(), at.y(), value);
        sum += value * value;
      }
      if (seen) points.push_back({p_B, std::sqrt(sum / exposures)});
    }
  return points;
}

// A point as the picture shows it, and how that changes with the pose.
struct Look {
  float expected, seen;
  double steepness_px;  // grey levels a pixel
  Eigen::Matrix<double, 6, 1> slope;
};

std::vector<Look> look(const cv::Mat1b& grey, int level, const Intrinsics& camera,
                       const std::vector<BoardPoint>& points, const Isometry3d& X_CB) {
  std::vector<Look> looks;
  looks.reserve(points.size());
  for (const BoardPoint& point : points) {
    const Vector3d r_C = X_CB.linear() * point.p_B;
    const Vector3d p_C = r_C + X_CB.translation();
    if (!(p_C.z() > least_depth_m)) continue;
    const Vector2d at = to_level(project(camera, p_C), level);
    float here = 0, left = 0, right = 0, above = 0, below = 0;
    if (!sample(grey, at.x(), at.y(), here) || !sample(grey, at.x() - 1, at.y(), left) ||
        !sample(grey, at.x() + 1, at.y(), right) || !sample(grey, at.x(), at.y() - 1, above) ||
        !sample(grey, at.x(), at.y() + 1, below))
      continue;
    const double scale = 1.0 / (1 << level);
    const double a = 0.5 * (right - left) * scale * camera.fx / p_C.z();
    const double b = 0.5 * (below - above) * scale * camera.fy / p_C.z();
    const Vector3d g(a, b, -(a * p_C.x() + b * p_C.y()) / p_C.z());
    Look seen{point.expected, here, 0.5 * scale * std::hypot(right - left, below - above), {}};
    seen.slope << g, r_C.cross(g);
    looks.push_back(seen);
  }
  return looks;
}

float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// seen = gain * expected + bias, from medians: a hand over a third of the board does not matter.
struct Light {
  double gain = 1, bias = 0;
  double of(float expected) const { return gain * expected + bias; }
};

Light light_of(const std::vector<Look>& looks) {
  std::vector<float> expected, seen;
  for (const Look& l : looks) {
    expected.push_back(l.expected);
    seen.push_back(l.seen);
  }
  const float from = median(expected), to = median(seen);
  for (float& value : expected) value = std::abs(value - from);
  for (float& value : seen) value = std::abs(value - to);
  const double gain = std::clamp(median(seen) / std::max(1.0F, median(expected)), 0.3F, 3.0F);
  return {gain, to - gain * from};
}

// 1: every point looks as expected; 0: all are off by half of what light and dark differ by, or more.
double likeness_of(const std::vector<Look>& looks, const Light& light) {
  std::vector<float> expected;
  for (const Look& l : looks) expected.push_back(static_cast<float>(light.of(l.expected)));
  const auto at = [&](double share) {
    const auto place = expected.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(expected.size() - 1));
    std::nth_element(expected.begin(), place, expected.end());
    return *place;
  };
  const float darkest = at(0.1), brightest = at(0.9);
  const double limit = 0.5 * std::max(2.0F, brightest - darkest);
  double sum = 0;
  for (const Look& l : looks) {
    const double ratio = (light.of(l.expected) - l.seen) / limit;
    if (std::abs(ratio) < 1) sum += (1 - ratio * ratio) * (1 - ratio * ratio);
  }
  return sum / static_cast<double>(looks.size());
}

// Lamps seldom change from one picture to the next; a hand that covers much upsets the medians.
Light first_light(const std::vector<Look>& looks) {
  const Light changed = light_of(looks), unchanged;
  return likeness_of(looks, changed) > likeness_of(looks, unchanged) ? changed : unchanged;
}

// One Gauss-Newton step of pose and light. False if it cannot be made.
bool improve(const std::vector<Look>& looks, Light& light, ReferenceFit& fit) {
  std::vector<float> off;
  for (const Look& l : looks) off.push_back(static_cast<float>(std::abs(l.seen - light.of(l.expected))));
  const double sigma = std::max(least_sigma, 1.48 * median(off));
  Matrix8 A = Matrix8::Zero();
  Vector8 b = Vector8::Zero();
  fit.searched = looks.size();
  fit.agreeing = 0;
  double squares = 0, steepness = 0;
  for (const Look& l : looks) {
    const double residual = light.of(l.expected) - l.seen;
    const double ratio = residual / (agrees * sigma);
    if (std::abs(ratio) >= 1) continue;
    const double weight = (1 - ratio * ratio) * (1 - ratio * ratio);
    Vector8 J;
    J << l.slope, -l.expected, -1;
    A.noalias() += weight * J * J.transpose();
    b += weight * residual * J;
    squares += weight * residual * residual;
    steepness += weight * l.steepness_px * l.steepness_px;
    ++fit.agreeing;
  }
  if (fit.agreeing < fewest_in_both) return false;
  fit.rms_px = std::sqrt(squares / std::max(1.0, steepness));
  fit.information = A.topLeftCorner<6, 6>() / (sigma * sigma);
  const Vector8 scaling = A.diagonal().cwiseMax(1e-9).cwiseSqrt().cwiseInverse();
  Matrix8 scaled = scaling.asDiagonal() * A * scaling.asDiagonal();
  scaled.diagonal().array() += 1e-6;
  const Vector8 step = scaling.cwiseProduct(Vector8(solve_normal(scaled, Vector8(scaling.cwiseProduct(b)))));
  if (!step.allFinite()) return false;
  fit.X_CB = moved(fit.X_CB, step.head<3>(), step.segment<3>(3));
  light.gain += step(6);
  light.bias += step(7);
  return fit.X_CB.translation().z() > least_depth_m;
}

}  // namespace

std::optional<ReferenceFit> fit_to_reference(const Pyramid& pyramid, const Intrinsics& camera,
                                             const ReferenceView& reference, const BoardGeometry& board,
                                             const Isometry3d& start_X_CB, const MotionBlur& blur) {
  ReferenceFit fit;
  fit.X_CB = start_X_CB;
  const auto levels = static_cast<int>(std::min(pyramid.levels.size(), reference.pyramid.levels.size()));
  for (const Round& round : rounds) {
    if (round.level >= levels) continue;
    MotionBlur now = blur;
    now.X_CB_now = fit.X_CB;
    const std::vector<BoardPoint> points = expect(reference, board, fit.X_CB, now, round.level);
    std::optional<Light> light;
    for (int i = 0; i < round.iterations; ++i) {
      const std::vector<Look> looks =
          look(pyramid.levels[static_cast<std::size_t>(round.level)], round.level, camera, points, fit.X_CB);
      if (looks.size() < fewest_in_both) return std::nullopt;
      if (!light) light = first_light(looks);
      if (i + 1 == round.iterations) fit.likeness = likeness_of(looks, *light);
      if (!improve(looks, *light, fit)) return std::nullopt;
    }
  }
  return fit;
}

}  // namespace counterpart
