#include "tracker_server/pose/model_tracker.hpp"

#include <algorithm>
#include <utility>

#include <nlopt.h>

namespace counterpart {
namespace {

using Eigen::Isometry3d;

constexpr int most_frames_unseen = 2;

// So many edges found within a few pixels of where they were expected are not looked for farther away, where print on a
// face or things behind it may look more like them than they do themselves.
constexpr double plenty = 0.6;

// Clutter behind an outline and texture on a face give edges as well: a pose counts when more agrees than chance does.
constexpr double least_edges_seen = 0.25;
constexpr double worst_rms_px = 2.0;
constexpr std::size_t fewest_points = 20;

// Enough points for a fit to average over, few enough for a millisecond.
constexpr std::size_t wanted_samples = 800;

const std::vector<FitRound> tight_rounds = {{0, 4, 1, 2}, {0, 3, 1, 2}};
const std::vector<FitRound> near_rounds = {{1, 7, 2, 2}, {0, 6, 1, 2}, {0, 4, 1, 2}};
const std::vector<FitRound> far_rounds = {{2, 8, 1, 3}, {1, 8, 1, 2}, {0, 6, 1, 2}, {0, 4, 1, 2}};

bool good(const PoseFit& fit) {
  return fit.X_CM.matrix().allFinite() && fit.X_CM.translation().z() > 0 && fit.accepted >= fewest_points &&
         fit.share() >= least_edges_seen && fit.rms_px <= worst_rms_px;
}

}  // namespace

ModelTracker::ModelTracker(Model model, Predictor predictor, const Optimizer& optimizer)
    : model_(std::move(model)),
      samples_(sample_edges_in_all(model_, wanted_samples)),
      motion_(predictor),
      optimizer_(optimizer) {}

void ModelTracker::start_at(const Isometry3d& X_CM) {
  motion_.forget();
  last_X_CM_ = X_CM;
  frames_unseen_ = most_frames_unseen;
}

PoseFit ModelTracker::attempt(const Pyramid& pyramid, const Intrinsics& camera, const Isometry3d& start,
                              const std::vector<FitRound>& rounds) const {
  const auto visible = visible_samples(model_, samples_, start);
  if (!optimizer_.gradient_image) return fit_pose(pyramid, model_, samples_, visible, camera, start, rounds, {});
  const Isometry3d X_CM = fit_to_gradient(pyramid, samples_, visible, camera, start, optimizer_);
  return judge_pose(pyramid, model_, samples_, visible_samples(model_, samples_, X_CM), camera, X_CM);
}

// Farther than edges are searched: the gradient image pulls from all sides, the edges then make the pose exact.
PoseFit ModelTracker::search(const Pyramid& pyramid, const Intrinsics& camera, const Isometry3d& start) const {
  const auto visible = visible_samples(model_, samples_, start);
  const Isometry3d near = fit_to_gradient(pyramid, samples_, visible, camera, start, {true, NLOPT_LN_BOBYQA}, 60);
  return attempt(pyramid, camera, near, near_rounds);
}

// What was not searched in the last round is not known either.
void ModelTracker::remember(const PoseFit& fit) {
  for (EdgeSample& sample : samples_) remember_look({}, sample);
  for (std::size_t i = 0; i < fit.hits.size(); ++i) remember_look(fit.hits[i], samples_[fit.samples[i]]);
}

TrackedModel ModelTracker::track(const Pyramid& pyramid, const Intrinsics& camera, std::int64_t time_ns) {
  TrackedModel result;
  if (!last_X_CM_) return result;
  const bool was_lost = frames_unseen_ > most_frames_unseen;
  const Isometry3d predicted = frames_unseen_ == 0 ? motion_.predict(time_ns) : *last_X_CM_;
  result.fit = attempt(pyramid, camera, predicted, tight_rounds);
  if (!good(result.fit) || result.fit.share() < plenty) {
    PoseFit farther = attempt(pyramid, camera, predicted, near_rounds);
    if (!good(result.fit) || farther.share() > result.fit.share()) result.fit = std::move(farther);
  }
  if (!good(result.fit)) result.fit = attempt(pyramid, camera, predicted, far_rounds);
  if (!good(result.fit)) result.fit = attempt(pyramid, camera, *last_X_CM_, far_rounds);
  if (!good(result.fit)) result.fit = search(pyramid, camera, *last_X_CM_);

  if (good(result.fit)) {
    if (was_lost) motion_.forget();
    result.status = was_lost ? TrackStatus::relocalised : TrackStatus::ok;
    result.X_CM = result.fit.X_CM;
    last_X_CM_ = result.X_CM;
    motion_.add(result.X_CM, time_ns);
    remember(result.fit);
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
