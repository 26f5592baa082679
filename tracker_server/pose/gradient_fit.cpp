#include "tracker_server/pose/gradient_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>

#include <nlopt.hpp>
#include <opencv2/imgproc.hpp>

#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int gradient_level = 1;  // half the width and height: a quarter of the pixels
constexpr int most_evaluations = 400;
constexpr double step_px = 3;     // of the first step, in the picture
constexpr double settled = 1e-3;  // pixels

cv::Mat1f gradient_of(const cv::Mat1b& grey) {
  cv::Mat1b smooth;
  cv::GaussianBlur(grey, smooth, cv::Size(5, 5), 1.2);
  cv::Mat1f across, down, strength;
  cv::Sobel(smooth, across, CV_32F, 1, 0, 3, 0.125);
  cv::Sobel(smooth, down, CV_32F, 0, 1, 3, 0.125);
  cv::magnitude(across, down, strength);
  return strength;
}

struct Objective {
  cv::Mat1f gradient;
  int level = 0;
  const std::vector<EdgeSample>* samples = nullptr;
  const std::vector<std::size_t>* visible = nullptr;
  Intrinsics camera;
  Isometry3d start;
  Vector3d metres_a_pixel;  // along the camera's axes
  double radians_a_pixel = 0;

  // Parameters count in pixels of movement in the picture, so that one step size and tolerance serve all six.
  Isometry3d pose(const double* x) const {
    const Vector3d translation = metres_a_pixel.cwiseProduct(Vector3d(x[0], x[1], x[2]));
    return moved(start, translation, radians_a_pixel * Vector3d(x[3], x[4], x[5]));
  }

  double value(const double* x) const {
    const Isometry3d X_CM = pose(x);
    double sum = 0;
    for (const std::size_t i : *visible) {
      const Vector3d p_C = X_CM * (*samples)[i].p_M;
      if (!(p_C.z() > 1e-3)) continue;
      const Vector2d p = project(camera, p_C);
      const float u = Pyramid::to_level(static_cast<float>(p.x()), level);
      const float v = Pyramid::to_level(static_cast<float>(p.y()), level);
      if (!(u >= 0 && v >= 0 && u < static_cast<float>(gradient.cols - 1) && v < static_cast<float>(gradient.rows - 1)))
        continue;
      const int col = static_cast<int>(u), row = static_cast<int>(v);
      const float fu = u - static_cast<float>(col), fv = v - static_cast<float>(row);
      const float* a = gradient.ptr<float>(row) + col;
      const float* b = gradient.ptr<float>(row + 1) + col;
      sum += (1 - fv) * (a[0] + fu * (a[1] - a[0])) + fv * (b[0] + fu * (b[1] - b[0]));
    }
    return sum / static_cast<double>(visible->size());
  }
};

double evaluate(unsigned, const double* x, double* slope, void* data) {
  const Objective& objective = *static_cast<const Objective*>(data);
  if (slope != nullptr) {
    constexpr double aside = 0.25;  // pixels
    std::array<double, 6> moved_x{};
    std::copy(x, x + 6, moved_x.begin());
    for (std::size_t i = 0; i < 6; ++i) {
      moved_x[i] = x[i] + aside;
      const double after = objective.value(moved_x.data());
      moved_x[i] = x[i] - aside;
      slope[i] = (after - objective.value(moved_x.data())) / (2 * aside);
      moved_x[i] = x[i];
    }
  }
  return objective.value(x);
}

}  // namespace

Result<Optimizer> optimizer_from(const std::string& name) {
  if (name == "gauss-newton") return Optimizer{};
  const std::string prefix = "nlopt:";
  if (name.rfind(prefix, 0) == 0) {
    const std::string algorithm = name.substr(prefix.size());
    const nlopt_algorithm known = nlopt_algorithm_from_string(algorithm.c_str());
    const bool whole = algorithm.find("AUGLAG") == std::string::npos && algorithm.find("MLSL") == std::string::npos;
    if (static_cast<int>(known) >= 0 && known < NLOPT_NUM_ALGORITHMS && whole)
      return Optimizer{true, static_cast<int>(known)};
  }
  return failure(ErrorCode::invalid_argument, "\"" + name +
                                                  "\" is no optimizer; choose gauss-newton or nlopt:ALGORITHM, for "
                                                  "example nlopt:LN_BOBYQA or nlopt:LD_MMA.");
}

Isometry3d fit_to_gradient(const Pyramid& pyramid, const std::vector<EdgeSample>& samples,
                           const std::vector<std::size_t>& visible, const Intrinsics& camera, const Isometry3d& start,
                           const Optimizer& optimizer, double reach_px) {
  const double depth = start.translation().z();
  double radius = 0;
  for (const std::size_t i : visible) radius = std::max(radius, samples[i].p_M.norm());
  if (visible.empty() || !(depth > 0) || !(radius > 0)) return start;

  Objective objective;
  objective.level = std::min(gradient_level, static_cast<int>(pyramid.levels.size()) - 1);
  objective.gradient = gradient_of(pyramid.levels[static_cast<std::size_t>(objective.level)]);
  objective.samples = &samples;
  objective.visible = &visible;
  objective.camera = camera;
  objective.start = start;
  const double metres = depth / camera.fx;
  objective.metres_a_pixel = Vector3d(metres, metres, metres * depth / radius);
  objective.radians_a_pixel = metres / radius;

  std::vector<double> x(6, 0.0);
  try {
    nlopt::opt search(static_cast<nlopt::algorithm>(optimizer.nlopt_algorithm), 6);
    search.set_max_objective(evaluate, &objective);
    search.set_lower_bounds(-reach_px);
    search.set_upper_bounds(reach_px);
    search.set_initial_step(step_px);
    search.set_xtol_abs(settled);
    search.set_maxeval(most_evaluations);
    double best = 0;
    search.optimize(x, best);
  } catch (const std::exception&) {
    // NLopt reports rounding limits this way; x then holds the best point so far.
  }
  return objective.pose(x.data());
}

PoseFit judge_pose(const Pyramid& pyramid, const Model& model, const std::vector<EdgeSample>& samples,
                   const std::vector<std::size_t>& visible, const Intrinsics& camera, const Isometry3d& X_CM) {
  PoseFit fit = fit_pose(pyramid, model, samples, visible, camera, X_CM, {{0, 4, 1, 1}}, {});
  fit.X_CM = X_CM;
  return fit;
}

}  // namespace counterpart
