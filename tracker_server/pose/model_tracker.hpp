// Any polygonal model followed from frame to frame, from a pose that is given.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "protocol/vocabulary/pose.hpp"
#include "tracker_server/pose/gradient_fit.hpp"
#include "tracker_server/pose/model.hpp"
#include "tracker_server/pose/motion.hpp"

namespace counterpart {

struct TrackedModel {
  TrackStatus status = TrackStatus::lost;
  Eigen::Isometry3d X_CM = Eigen::Isometry3d::Identity();
  PoseFit fit;  // of the last attempt if that failed
};

class ModelTracker {
 public:
  ModelTracker(Model model, Predictor predictor, const Optimizer& optimizer);

  void start_at(const Eigen::Isometry3d& X_CM);

  // time_ns grows from call to call. While lost it goes on looking where the model was seen last.
  TrackedModel track(const Pyramid& pyramid, const Intrinsics& camera, std::int64_t time_ns);

  const Model& model() const { return model_; }

 private:
  PoseFit attempt(const Pyramid& pyramid, const Intrinsics& camera, const Eigen::Isometry3d& start,
                  const std::vector<FitRound>& rounds) const;
  PoseFit search(const Pyramid& pyramid, const Intrinsics& camera, const Eigen::Isometry3d& start) const;
  void remember(const PoseFit& fit);

  Model model_;
  std::vector<EdgeSample> samples_;
  Motion motion_;
  Optimizer optimizer_;
  std::optional<Eigen::Isometry3d> last_X_CM_;
  int frames_unseen_ = 0;
};

}  // namespace counterpart
