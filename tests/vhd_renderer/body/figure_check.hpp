// What every figure has to fulfil, whoever made it.
#pragma once

#include <set>

#include <gtest/gtest.h>

#include "vhd_renderer/body/figure.hpp"

namespace counterpart {

inline int joint_index(const Figure& figure, const std::string& name) {
  for (std::size_t i = 0; i < figure.joints.size(); ++i) {
    if (figure.joints[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

inline Eigen::Vector3f joint_place(const Figure& figure, const std::string& name) {
  const int i = joint_index(figure, name);
  EXPECT_GE(i, 0) << name;
  return i < 0 ? Eigen::Vector3f::Zero()
               : Eigen::Vector3f(figure.joints[static_cast<std::size_t>(i)].X_HJ.translation());
}

inline void expect_sound(const Figure& figure) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < figure.joints.size(); ++i) {
    const Joint& joint = figure.joints[i];
    EXPECT_LT(joint.parent, static_cast<int>(i)) << joint.name;
    EXPECT_TRUE(names.insert(joint.name).second) << joint.name << " twice";
    const Eigen::Isometry3f above =
        joint.parent < 0 ? Eigen::Isometry3f::Identity() : figure.joints[static_cast<std::size_t>(joint.parent)].X_HJ;
    EXPECT_LT(((above * joint.X_PJ).translation() - joint.X_HJ.translation()).norm(), 1e-4F) << joint.name;
  }
  float lowest = 9;
  float highest = -9;
  for (const FigurePart& part : figure.parts) {
    const std::size_t n = part.positions_m.size();
    ASSERT_EQ(part.normals.size(), n) << part.name;
    ASSERT_EQ(part.uvs.size(), n) << part.name;
    ASSERT_EQ(part.joints.size(), n) << part.name;
    ASSERT_EQ(part.weights.size(), n) << part.name;
    ASSERT_EQ(part.triangles.size() % 3, 0U) << part.name;
    for (const std::uint32_t v : part.triangles) ASSERT_LT(v, n) << part.name;
    for (std::size_t v = 0; v < n; ++v) {
      lowest = std::min(lowest, part.positions_m[v].z());
      highest = std::max(highest, part.positions_m[v].z());
      ASSERT_NEAR(part.normals[v].norm(), 1.F, 1e-3F) << part.name;
      float sum = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_LT(part.joints[v][k], figure.joints.size()) << part.name;
        sum += part.weights[v][k];
      }
      ASSERT_NEAR(sum, 1.F, 1e-3F) << part.name;
    }
    EXPECT_LT(part.texture, static_cast<int>(figure.textures.size())) << part.name;
  }
  EXPECT_NEAR(lowest, 0.F, 1e-3F);
  EXPECT_GT(highest, 1.4F);
  EXPECT_LT(highest, 2.1F);
  // Left is -x, the face looks along +y, up is z.
  EXPECT_LT(joint_place(figure, "l_shoulder").x(), -0.1F);
  EXPECT_GT(joint_place(figure, "r_shoulder").x(), 0.1F);
  EXPECT_GT(joint_place(figure, "l_midtarsal").y(), joint_place(figure, "l_ankle").y() + 0.05F);
  EXPECT_GT(joint_place(figure, "skullbase").z(), joint_place(figure, "HumanoidRoot").z() + 0.4F);
}

inline const std::vector<std::string>& needed_joints() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{"HumanoidRoot", "vl5", "vt1", "vc7", "skullbase"};
    for (const std::string side : {"l_", "r_"}) {
      for (const char* name :
           {"hip", "knee", "ankle", "midtarsal", "sternoclavicular", "shoulder", "elbow", "wrist", "eyeball_joint"}) {
        all.push_back(side + name);
      }
      for (const char* finger : {"thumb", "index", "middle", "ring", "pinky"}) {
        for (const char* part : {"1", "2", "3"}) all.push_back(side + finger + part);
        all.push_back(side + finger + "_distal_tip");
      }
    }
    return all;
  }();
  return names;
}

}  // namespace counterpart
