// Several objects in one picture, each with its pose. Those that are rigid to each other are fitted as one (the paper's
// future work, section 5).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tracker_server/pose/joined_model.hpp"
#include "tracker_server/pose/model_tracker.hpp"

namespace counterpart {

struct ObjectToTrack {
  std::string name;
  Model model;
  Eigen::Isometry3d X_CM;  // in the picture to start with
};

struct TrackedObject {
  std::string name;
  TrackStatus status = TrackStatus::lost;
  Eigen::Isometry3d X_CM = Eigen::Isometry3d::Identity();
  double rms_px = 0;  // of the whole group
};

class ObjectTracker {
 public:
  struct Member {
    std::string name;
    Eigen::Isometry3d X_GM;
  };
  struct Group {
    std::vector<Member> members;
    ModelTracker tracker;
    TrackedModel seen;  // in the last picture; X_CM is the group's
  };

  ObjectTracker(Predictor predictor, const Optimizer& optimizer) : predictor_(predictor), optimizer_(optimizer) {}

  // Objects that keep their places to each other as they have them in the picture to start with; one alone moves
  // freely.
  void add(std::vector<ObjectToTrack> group);

  // In the order in which they were added. time_ns grows from call to call.
  std::vector<TrackedObject> track(const Pyramid& pyramid, const Intrinsics& camera, std::int64_t time_ns);

  const std::vector<Group>& groups() const { return groups_; }

 private:
  Predictor predictor_;
  Optimizer optimizer_;
  std::vector<Group> groups_;
};

}  // namespace counterpart
