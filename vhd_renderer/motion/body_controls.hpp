// Everything that motion decides about a body at one moment. The solver turns it into a pose; because all of it varies
// smoothly, so does the pose.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vhd_renderer/motion/anatomy.hpp"
#include "vhd_renderer/motion/hand.hpp"
#include "vhd_renderer/motion/wrist.hpp"

namespace counterpart {

// Turns in radians: pitch bends forward / looks down, roll leans to the right, yaw turns to the left.
struct Turn {
  float pitch = 0;
  float roll = 0;
  float yaw = 0;

  Turn operator+(const Turn& o) const { return {pitch + o.pitch, roll + o.roll, yaw + o.yaw}; }
  Turn operator*(float k) const { return {pitch * k, roll * k, yaw * k}; }
};

struct ArmGoal {
  Eigen::Vector3f wrist_S{0, 0, 0};
  Eigen::Quaternionf R_SW = Eigen::Quaternionf::Identity();  // hand frame W
  float swivel_rad = 0;                                      // lifts the elbow away from its natural place
  float help = 1;                                            // 0..1: how far the trunk leans to reach it
  HandShape shape;
};

struct FootGoal {
  Eigen::Vector3f ball_S{0, 0, 0};  // point of the sole under the toe joint
  float heading_rad = 0;            // of the foot, about z from S's y axis
  float pitch_rad = 0;              // heel up, turning about the ball
};

struct BodyControls {
  Eigen::Vector3f pelvis_S{0, 0, 0};     // middle between the hip joints
  float heading_rad = 0;                 // of the pelvis, about z from S's y axis
  Turn pelvis;                           // beyond the heading
  Turn spine;                            // all of it together
  Turn head;                             // added to where the gaze takes it
  Eigen::Vector3f gaze_S{0, 1, 0};       // what the eyes are on
  Eigen::Vector3f head_gaze_S{0, 1, 0};  // what the head turns to; follows more slowly
  float head_share = 0.7F;               // of the gaze that the head does
  std::array<float, 2> shrug{0, 0};      // 0..1
  std::array<ArmGoal, 2> arms;
  std::array<FootGoal, 2> feet;
  Eigen::Vector3f rise_S{0, 0,
                         0};      // how far the pelvis can come up and forward off the chair when leaning is not enough
  float chair_y = 0;              // of the hips that sit on the chair as it stands now
  float dt_s = 0;                 // since the frame before; 0: there was none
  float table_z_m = -0.015F;      // elbows and forearms stay above it ...
  float table_edge_y_m = -0.36F;  // ... beyond this line; far away when he does not sit at it
  float board_half_m = 0;         // half a side of the board that lies on it, its top at z = 0; 0: none does
  std::map<std::string, float> morphs;
  float jaw_rad = 0;
};

// T: the upper trunk's own frame, its axes as at bind.
struct ArmMemory {
  WristAngles bend;                                             // of the wrist
  float twist_rad = 0;                                          // of the upper arm's twist joint
  Eigen::Vector3f wrist_T{0, 0, 0};                             // its place
  Eigen::Quaternionf upper_T = Eigen::Quaternionf::Identity();  // of the two bones, from bind
  Eigen::Quaternionf fore_T = Eigen::Quaternionf::Identity();
};

// What a body cannot change in a jump; kept from frame to frame.
struct BodyMemory {
  std::array<ArmMemory, 2> arms;
  std::array<float, 2> lean{0, 0};  // of the trunk, 0..1, for each arm's sake
  float rise = 0;                   // off the chair, 0..1
};

struct SolvedBody {
  BodyPose pose;
  std::array<float, 2> arm_gap_m{0, 0};  // of the palm from where its goal has it
  std::array<float, 2> foot_gap_m{0, 0};
  std::optional<BodyMemory> before;  // nothing: there was no frame before, and every pose is near
};

// The one body solver: pelvis, trunk with the lean that the arms need, legs, head and eyes, arms, fingers.
void solve_body(const Figure& figure, const Anatomy& anatomy, const BodyControls& controls, SolvedBody& solved);

// Rotation of a body turned by `heading` and then by `turn`.
Eigen::Quaternionf rotation_of(float heading_rad, const Turn& turn);

}  // namespace counterpart
