// Rigid transforms and what the tracker says of one.
#pragma once

#include <array>
#include <cstdint>

#include "protocol/vocabulary/stamp.hpp"

namespace counterpart {

using Point3 = std::array<double, 3>;  // metres, in the frame that the name's last letter gives

// X_AB takes a point written in frame B to frame A: p_A = R(q) p_B + p.
struct Pose {
  std::array<double, 4> q{1, 0, 0, 0};  // unit quaternion w, x, y, z
  Point3 p{0, 0, 0};                    // metres

  friend bool operator==(const Pose&, const Pose&) = default;
};

enum class TrackStatus : std::uint8_t {
  ok = 1,           // fitted to this picture
  coasting = 2,     // predicted, this picture did not suffice
  lost = 3,         // no pose; X_CB must not be used
  relocalised = 4,  // fitted after a loss: the pose may have jumped
};

struct PoseEstimate {
  FrameStamp stamp;
  std::uint32_t object_id = 0;  // 0 is the board
  TrackStatus status = TrackStatus::lost;
  Pose X_CB;
  // Upper triangle by rows of the 6x6 covariance of (translation in metres, rotation vector in radians), both in C.
  std::array<float, 21> covariance{};
  float rms_px = 0;                 // of the edge points that were accepted
  float seen_share = 0;             // 0..1, share of the visible model's edge points that found their edge
  std::uint32_t intrinsics_id = 0;  // the Intrinsics this pose was fitted with

  friend bool operator==(const PoseEstimate&, const PoseEstimate&) = default;
};

inline bool usable(const PoseEstimate& pose) {
  return pose.status != TrackStatus::lost;
}

}  // namespace counterpart
