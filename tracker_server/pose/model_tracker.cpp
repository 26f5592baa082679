#include "tracker_server/pose/model_tracker.hpp"

#include <algorithm>
#include <utility>

#include <nlopt.h>

namespace counterpart {
namespace {

using Eigen::Isometry3d;

constexpr int most_frames_unseen = 2;

// Clutter behind an outline and texture on a face give edges as well: a pose counts when more agrees than chance does.
constexpr double least_edges_seen = 0.25;
constexpr double worst_rms_px = 2.0;
constexpr std::size_t fewest_points = 20;

// Enough points for a fit to average over, few enough for a millisecond.
constexpr std::size_t wanted_samples = 800;

const std::vector<FitRound> near_rounds = {{1, 7, 2, 2}, {0, 6, 1, 2}, {0, 4, 1, 2}};
const std::vector<FitRound> far_rounds = {{2, 8, 1, 3}, {1, 8, 1, 2}, {0, 6, 1, 2}, {0, 4, 1, 2}};

int samples_a_segment(const Model& model) {
  return static_cast<int>(
      std::clamp<std::size_t>(wanted_samples / std::max<std::size_t>(1, model.segments.size()), 3, 60));
}

bool good(const PoseFit& fit) {
  return fit.X_CM.matrix().allFinite() && fit.X_CM.translation().z() > 0 && fit.accepted >= fewest_points &&
         fit.share() >= least_edges_seen && fit.rms_px <= worst_rms_px;
}

}  // namespace

ModelTracker::ModelTracker(Model model, const Intrinsics& camera, Predictor predictor, const Optimizer& optimizer)
    : model_(std::move(model)),
      samples_(sample_edges(model_, samples_a_segment(model_))),
      camera_(camera),
      motion_(predictor),
      optimizer_(optimizer) {}

void ModelTracker::start_at(const Isometry3d& X_CM) {
  motion_.forget();
  last_X_CM_ = X_CM;
  frames_unseen_ = most_frames_unseen;
}

PoseFit ModelTracker::attempt(const Pyramid& pyramid, const Isometry3d& start,
                              const std::vector<FitRound>& rounds) const {
  const auto visible = visible_samples(model_, samples_, start);
  if (!optimizer_.gradient_image) return fit_pose(pyramid, samples_, visible, camera_, start, rounds, {});
  const Isometry3d X_CM = fit_to_gradient(pyramid, samples_, visible, camera_, start, optimizer_);
  return judge_pose(pyramid, samples_, visible_samples(model_, samples_, X_CM), camera_, X_CM);
}

// Farther than edges are searched: the gradient image pulls from all sides, the edges then make the pose exact.
PoseFit ModelTracker::search(const Pyramid& pyramid, const Isometry3d& start) const {
  const auto visible = visible_samples(model_, samples_, start);
  const Isometry3d near = fit_to_gradient(pyramid, samples_, visible, camera_, start, {true, NLOPT_LN_BOBYQA}, 60);
  return attempt(pyramid, near, near_rounds);
}

TrackedModel ModelTracker::track(const Pyramid& pyramid, std::int64_t time_ns) {
  TrackedModel result;
  if (!last_X_CM_) return result;
  const bool was_lost = frames_unseen_ > most_frames_unseen;
  const Isometry3d predicted = frames_unseen_ == 0 ? motion_.predict(time_ns) : *last_X_CM_;
  result.fit = attempt(pyramid, predicted, near_rounds);
  if (!good(result.fit)) result.fit = attempt(pyramid, predicted, far_rounds);
  if (!good(result.fit)) result.fit = attempt(pyramid, *last_X_CM_, far_rounds);
  if (!good(result.fit)) result.fit = search(pyramid, *last_X_CM_);

  if (good(result.fit)) {
    if (was_lost) motion_.forget();
    result.status = was_lost ? TrackStatus::relocalised : TrackStatus::ok;
    result.X_CM = result.fit.X_CM;
    last_X_CM_ = result.X_CM;
    motion_.add(result.X_CM, time_ns);
    frames_unseen_ = 0;
    return result;
  }
  if (++frames_unseen_ <= most_frames_unseen) {
    result.status = TrackStatus::coasting;
    result.X_CM = motion_.predict(time_ns);
  }
  return result;
}

}  // namespace counterpart
