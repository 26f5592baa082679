#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tracker_server/pose/fit.hpp"
#include "tracker_server/pose/model.hpp"

namespace counterpart {
namespace {

Result<Model> model_from(const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("counterpart_model_" + std::to_string(std::hash<std::string>{}(text)) + ".obj");
  std::ofstream(path) << text;
  auto model = read_obj_model(path);
  std::filesystem::remove(path);
  return model;
}

const std::string cube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST(ObjModel, ACubeHasTwelveEdgesOfWhichNineAreSeenFromACorner) {
  const auto model = model_from(cube);
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model->segments.size(), 12U);
  // Looked at along the diagonal: the three edges at the far corner are hidden.
  Eigen::Isometry3d X_CM = Eigen::Isometry3d::Identity();
  X_CM.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0, 0, -1)).matrix();
  X_CM.translation() = Eigen::Vector3d(0, 0, 5);
  const auto samples = sample_edges(*model, 5);
  EXPECT_EQ(visible_samples(*model, samples, X_CM).size(), 9U * 5);
}

TEST(ObjModel, EdgesInsideAFlatFaceAreLeftOutUnlessDrawn) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
  EXPECT_EQ(model_from(square)->segments.size(), 4U);
  EXPECT_EQ(model_from(square + "l 1 3\n")->segments.size(), 5U);
}

TEST(ObjModel, BadFilesNameTheLine) {
  EXPECT_NE(model_from("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n").error().message.find("line 4"), std::string::npos);
  EXPECT_FALSE(model_from("v 0 0 nan\n"));
  EXPECT_FALSE(model_from("v 0 0\n"));
  EXPECT_FALSE(model_from("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")) << "a face without area";
  EXPECT_FALSE(model_from("")) << "nothing to track";
  EXPECT_FALSE(read_obj_model("/nowhere/model.obj"));
}

}  // namespace
}  // namespace counterpart
