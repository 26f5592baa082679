#include "tracker_server/pipeline/debug_view.hpp"

#include <algorithm>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "tracker_server/pose/projection.hpp"

namespace counterpart {
namespace {

constexpr int fraction_bits = 4;  // of the coordinates that OpenCV draws at

constexpr float farthest_px = 30000;  // beyond any picture, within OpenCV's integers

cv::Point on_grid(float x, float y) {
  const auto fixed = [](float value) {
    return static_cast<int>(std::clamp(value, -farthest_px, farthest_px) * (1 << fraction_bits));
  };
  return {fixed(x), fixed(y)};
}

cv::Scalar colour_of(std::uint8_t verdict) {
  switch (static_cast<EdgeVerdict>(verdict)) {
    case EdgeVerdict::accepted:
      return {60, 220, 60};
    case EdgeVerdict::outlier:
      return {40, 40, 240};
    case EdgeVerdict::wrong_contrast:
      return {230, 60, 230};
    case EdgeVerdict::ambiguous:
      return {40, 220, 240};
    default:
      return {150, 150, 150};
  }
}

}  // namespace

DebugView debug_view(const Model& model, const Eigen::Isometry3d& X_CM, const Intrinsics& camera, const PoseFit& fit,
                     const FrameStamp& stamp) {
  DebugView view;
  view.stamp = stamp;
  const std::vector<EdgeSample> places = sample_edges(model, 2);
  std::vector<int> seen(model.segments.size());
  for (const std::size_t i : visible_samples(model, places, X_CM)) ++seen[static_cast<std::size_t>(places[i].segment)];
  for (std::size_t i = 0; i < model.segments.size(); ++i) {
    const Eigen::Vector3d a = X_CM * model.segments[i].a_M, b = X_CM * model.segments[i].b_M;
    if (seen[i] == 0 || !(a.z() > 0 && b.z() > 0)) continue;
    const Eigen::Vector2d p = project(camera, a), q = project(camera, b);
    view.lines.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(q.x()), static_cast<float>(q.y())});
  }
  for (std::size_t i = 0; i < fit.probes.size(); ++i) {
    const EdgeProbe& probe = fit.probes[i];
    const EdgeHit& hit = fit.hits[i];
    const float along = hit.verdict == EdgeVerdict::accepted || hit.verdict == EdgeVerdict::outlier ? hit.distance : 0;
    view.points.push_back(
        {probe.x + along * probe.nx, probe.y + along * probe.ny, static_cast<std::uint8_t>(hit.verdict)});
  }
  return view;
}

void draw_debug_view(const DebugView& view, cv::Mat& picture_bgr) {
  for (const auto& [x0, y0, x1, y1] : view.lines)
    cv::line(picture_bgr, on_grid(x0, y0), on_grid(x1, y1), {230, 170, 60}, 1, cv::LINE_AA, fraction_bits);
  for (const DebugPoint& point : view.points)
    cv::circle(picture_bgr, on_grid(point.x, point.y), 3 << (fraction_bits - 1), colour_of(point.verdict), cv::FILLED,
               cv::LINE_AA, fraction_bits);
}

}  // namespace counterpart
