// What motion needs to know of a figure: which joint is which, how long the limbs are, how the fingers bend.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/body/figure.hpp"

namespace counterpart {

enum Side2 : std::size_t { left_side = 0, right_side = 1 };

struct Finger {
  std::array<int, 3> joint{-1, -1, -1};
  Eigen::Vector3f axis_H{1, 0, 0};         // flexion turns about it, positive towards the palm
  Eigen::Vector3f spread_axis_H{0, 0, 1};  // positive spreads away from the middle finger, on the thumb's side
  std::array<float, 3> bind_flex_rad{};    // bend between hand or bone before and this bone
  Eigen::Vector3f tip_H{0, 0, 0};          // end of the flesh
  Eigen::Vector3f pad_H{0, 0, 0};          // middle of the pad, on the skin
  Eigen::Vector3f pad_normal_H{0, 0, 1};   // out of the pad
};

enum FingerName : std::size_t { thumb = 0, index_finger = 1, middle_finger = 2, ring_finger = 3, little_finger = 4 };

// The hand frame W: origin at the wrist, x along the middle hand bone, z out of the back of the hand, y = z cross x
// (the thumb's side of a left hand's palm is -y, of a right hand's +y).
struct HandParts {
  int wrist = -1;
  std::vector<int> below;  // every joint of the hand, parents first
  Eigen::Matrix3f R_HW = Eigen::Matrix3f::Identity();
  float thumb_side = 1;  // sign of y of the thumb
  std::array<Finger, 5> fingers;
};

// Upper and lower bone of an arm or a leg.
struct Limb {
  int root = -1;        // shoulder, hip
  int root_twist = -1;  // -1: the rig has none
  int middle = -1;      // elbow, knee
  int middle_twist = -1;
  int end = -1;  // wrist, ankle
  float upper_m = 0;
  float lower_m = 0;
  Eigen::Vector3f upper_H{0, 0, -1};  // unit, at bind
  Eigen::Vector3f lower_H{0, 0, -1};
  Eigen::Vector3f hinge_H{1, 0, 0};  // unit: bending turns the lower bone about it, positive closes the limb

  float length_m() const { return upper_m + lower_m; }
};

struct ArmParts {
  int clavicle = -1;
  std::vector<int> girdle;  // from the clavicle to the shoulder joint
  Limb limb;
  HandParts hand;
};

struct LegParts {
  Limb limb;
  int toe = -1;                     // the joint that the foot rolls over; -1: the foot is stiff
  std::vector<int> toes;            // all that hang on the foot, and bend there
  Eigen::Vector3f ball_H{0, 0, 0};  // of the foot, on the sole under the toe joint
  float toe_length_m = 0;           // from there to where the sole ends
  float ankle_height_m = 0.08F;
};

struct Anatomy {
  int root = -1;
  std::vector<int> trunk;  // from the root up to the joint that carries neck and arms
  std::vector<int> spine;  // of the trunk, without the root
  std::vector<int> neck;   // above the trunk, the head last
  int jaw = -1;
  std::array<int, 2> eyes{-1, -1};
  std::array<ArmParts, 2> arms;
  std::array<LegParts, 2> legs;
  float hip_height_m = 0.9F;    // of the hip joints at bind
  float seat_to_hip_m = 0.09F;  // hip joint above what he sits on
  float belly_m = 0.12F;        // front of the belly before the root
};

// Fails with the missing joint's name.
Result<Anatomy> anatomy_of(const Figure& figure);

}  // namespace counterpart
