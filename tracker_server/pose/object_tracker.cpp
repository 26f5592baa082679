#include "tracker_server/pose/object_tracker.hpp"

#include <utility>

namespace counterpart {

void ObjectTracker::add(std::vector<ObjectToTrack> group) {
  if (group.empty()) return;
  const Eigen::Isometry3d X_CG = group.front().X_CM;
  std::vector<Member> members;
  std::vector<PlacedModel> parts;
  for (ObjectToTrack& object : group) {
    const Eigen::Isometry3d X_GM = X_CG.inverse() * object.X_CM;
    members.push_back({std::move(object.name), X_GM});
    parts.push_back({std::move(object.model), X_GM});
  }
  ModelTracker tracker(joined_model(parts), predictor_, optimizer_);
  tracker.start_at(X_CG);
  groups_.push_back({std::move(members), std::move(tracker), {}});
}

std::vector<TrackedObject> ObjectTracker::track(const Pyramid& pyramid, const Intrinsics& camera,
                                                std::int64_t time_ns) {
  std::vector<TrackedObject> result;
  for (Group& group : groups_) {
    group.seen = group.tracker.track(pyramid, camera, time_ns);
    for (const Member& member : group.members)
      result.push_back({member.name, group.seen.status, group.seen.X_CM * member.X_GM, group.seen.fit.rms_px});
  }
  return result;
}

}  // namespace counterpart
