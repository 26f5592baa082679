// The real player's right arm: where its parts are for a place of the finger tips, and what it hides.
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "stage/room/blend_mesh.hpp"

namespace counterpart::stage {

struct ArmPose {
  Eigen::Isometry3d X_BHand =
      Eigen::Isometry3d::Identity();  // wrist at the origin, fingers along x, back of the hand up
  Eigen::Isometry3d X_BForearm = Eigen::Isometry3d::Identity();   // elbow at the origin, wrist along z
  Eigen::Isometry3d X_BUpperArm = Eigen::Isometry3d::Identity();  // shoulder at the origin, elbow along z
};

inline constexpr double kForearm_m = 0.26;
inline constexpr double kUpperArm_m = 0.29;
inline constexpr double kSleeve_m = 0.20;       // of the forearm: it ends before the wrist
inline constexpr float kSleeveNear_m = 0.052f;  // radius at the elbow
inline constexpr float kSleeveFar_m = 0.041f;
inline constexpr float kFingersMelt_m = 0.006f;  // how far apart parts of the hand still flow together

ArmPose arm_for(const Eigen::Vector3d& pinch_B);

// The hand in its own frame, fingers closed round a piece of this radius.
std::vector<Capsule> hand_capsules(float piece_radius_m);

// Where the forearm is bare, in its frame.
std::vector<Capsule> wrist_capsules();

MeshData sleeve_mesh(float length_m, float radius_near_m, float radius_far_m);

// Hand and sleeve in B, for asking what they hide.
std::vector<Capsule> arm_capsules(const ArmPose& pose, float piece_radius_m);

}  // namespace counterpart::stage
