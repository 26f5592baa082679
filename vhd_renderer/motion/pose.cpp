#include "vhd_renderer/motion/pose.hpp"

#include <cmath>

namespace counterpart {
namespace {

void update_joint(const Figure& figure, BodyPose& pose, std::size_t j) {
  const int parent = figure.joints[j].parent;
  if (parent < 0) {
    pose.G[j] = pose.turn[j];
    pose.p_S[j] = pose.root_p_S;
    return;
  }
  const Eigen::Vector3f offset = figure.joints[j].X_HJ.translation() - figure.joints[at(parent)].X_HJ.translation();
  pose.G[j] = (pose.G[at(parent)] * pose.turn[j]).normalized();
  pose.p_S[j] = pose.p_S[at(parent)] + pose.G[at(parent)] * offset;
}

Eigen::Matrix3f basis(const Eigen::Vector3f& along, const Eigen::Vector3f& side) {
  const Eigen::Vector3f x = along.normalized();
  Eigen::Vector3f y = side - x * x.dot(side);
  if (y.squaredNorm() < 1e-10F) y = x.unitOrthogonal();
  y.normalize();
  Eigen::Matrix3f M;
  M << x, y, x.cross(y);
  return M;
}

}  // namespace

Eigen::Isometry3f joint_frame_S(const Figure& figure, const BodyPose& pose, std::size_t joint) {
  Eigen::Isometry3f X_SJ = Eigen::Isometry3f::Identity();
  X_SJ.linear() = pose.G[joint].toRotationMatrix() * figure.joints[joint].X_HJ.linear();
  X_SJ.translation() = pose.p_S[joint];
  return X_SJ;
}

BodyPose bind_pose(const Figure& figure) {
  BodyPose pose;
  const std::size_t n = figure.joints.size();
  pose.turn.assign(n, Eigen::Quaternionf::Identity());
  pose.G.assign(n, Eigen::Quaternionf::Identity());
  pose.p_S.assign(n, Eigen::Vector3f::Zero());
  if (n > 0) pose.root_p_S = figure.joints[0].X_HJ.translation();
  update(figure, pose);
  return pose;
}

void update(const Figure& figure, BodyPose& pose, std::size_t first) {
  for (std::size_t j = first; j < figure.joints.size(); ++j) update_joint(figure, pose, j);
}

void update_chain(const Figure& figure, BodyPose& pose, const std::vector<int>& chain) {
  for (const int j : chain) update_joint(figure, pose, at(j));
}

void set_rotation(const Figure& figure, BodyPose& pose, int joint, const Eigen::Quaternionf& G_S) {
  const int parent = figure.joints[at(joint)].parent;
  pose.turn[at(joint)] = parent < 0 ? G_S : (pose.G[at(parent)].conjugate() * G_S).normalized();
  update_joint(figure, pose, at(joint));
}

Eigen::Quaternionf align(const Eigen::Vector3f& a_along, const Eigen::Vector3f& a_side, const Eigen::Vector3f& b_along,
                         const Eigen::Vector3f& b_side) {
  return Eigen::Quaternionf(basis(b_along, b_side) * basis(a_along, a_side).transpose()).normalized();
}

float twist_about(const Eigen::Quaternionf& q, const Eigen::Vector3f& axis) {
  const float along = q.vec().dot(axis);
  float angle = 2 * std::atan2(along, q.w());
  if (angle > static_cast<float>(M_PI)) angle -= 2 * static_cast<float>(M_PI);
  if (angle < -static_cast<float>(M_PI)) angle += 2 * static_cast<float>(M_PI);
  return angle;
}

}  // namespace counterpart
