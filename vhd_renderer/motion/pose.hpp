// A pose of a figure, in a form that does not depend on how its joints' own axes lie: every joint turns by a rotation
// written in the axes of H at bind, so that "identity" is the bind pose for every rig.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vhd_renderer/body/figure.hpp"

namespace counterpart {

// Joint `j` turned from bind: G[j] = G[parent] * turn[j]; p[j] = p[parent] + G[parent] * (bind offset).
// S: the seat frame, which is B for the light side and B turned by half a circle for the dark side.
struct BodyPose {
  Eigen::Vector3f root_p_S = Eigen::Vector3f::Zero();
  std::vector<Eigen::Quaternionf> turn;  // by joint
  std::vector<Eigen::Quaternionf> G;     // bind directions in H to directions in S
  std::vector<Eigen::Vector3f> p_S;
};

// A joint's place in the vectors of a figure or a pose; joints count from 0, and -1 means none.
inline std::size_t at(int joint) {
  return static_cast<std::size_t>(joint);
}

BodyPose bind_pose(const Figure& figure);

// A joint's own frame where the pose has it.
Eigen::Isometry3f joint_frame_S(const Figure& figure, const BodyPose& pose, std::size_t joint);

// Fills G and p_S of the joints from `first` on.
void update(const Figure& figure, BodyPose& pose, std::size_t first = 0);

// Fills G and p_S along one chain, given from its upper end; the upper end's parent has to be up to date.
void update_chain(const Figure& figure, BodyPose& pose, const std::vector<int>& chain);

// Sets a joint's turn so that it gets rotation G_S, its parent being up to date.
void set_rotation(const Figure& figure, BodyPose& pose, int joint, const Eigen::Quaternionf& G_S);

// Rotation that takes the pair (a along, a side) to (b along, b side): along exactly, side as near as can be.
Eigen::Quaternionf align(const Eigen::Vector3f& a_along, const Eigen::Vector3f& a_side, const Eigen::Vector3f& b_along,
                         const Eigen::Vector3f& b_side);

// The angle by which q turns about `axis` (unit), -pi..pi.
float twist_about(const Eigen::Quaternionf& q, const Eigen::Vector3f& axis);

}  // namespace counterpart
