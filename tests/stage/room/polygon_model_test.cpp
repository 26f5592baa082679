#include "stage/room/polygon_model.hpp"

#include <algorithm>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace counterpart::stage {
namespace {

constexpr ObjectKind kKinds[] = {ObjectKind::box, ObjectKind::table, ObjectKind::chair};

TEST(PolygonModel, FacesLookOutwards) {
  for (const ObjectKind kind : kKinds) {
    const PolygonModel model = polygon_model(kind, usual_size_m(kind));
    for (const std::vector<int>& face : model.faces) {
      const auto at = [&](std::size_t i) { return model.vertices_O[static_cast<std::size_t>(face[i])]; };
      const Eigen::Vector3d normal = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
      const Eigen::Vector3d middle = (at(0) + at(2)) / 2;
      // Just inside of a face is a block, which a way straight through it meets.
      EXPECT_TRUE(comes_between(model, middle + 0.001 * normal, middle - 0.002 * normal));
      EXPECT_FALSE(comes_between(model, middle + 0.001 * normal, middle + 0.002 * normal));
    }
  }
}

TEST(PolygonModel, HasItsSizeAndItsOriginInTheMiddle) {
  for (const ObjectKind kind : kKinds) {
    const Eigen::Vector3d size = usual_size_m(kind);
    Eigen::Vector3d low = Eigen::Vector3d::Constant(9), high = -low;
    for (const Eigen::Vector3d& v : polygon_model(kind, size).vertices_O) {
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    EXPECT_TRUE(low.isApprox(-size / 2, 1e-9)) << low.transpose();
    EXPECT_TRUE(high.isApprox(size / 2, 1e-9)) << high.transpose();
  }
}

TEST(PolygonModel, TheMeshHasTheFacesAreaWhateverItsCells) {
  for (const ObjectKind kind : kKinds) {
    const PolygonModel model = polygon_model(kind, usual_size_m(kind));
    double areas[2] = {0, 0};
    for (const int i : {0, 1}) {
      const MeshData mesh = mesh_of(model, i == 0 ? 10 : 0.05);
      for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
        const Eigen::Vector3f a = mesh.positions_m[mesh.triangles[t]];
        const Eigen::Vector3f normal =
            (mesh.positions_m[mesh.triangles[t + 1]] - a).cross(mesh.positions_m[mesh.triangles[t + 2]] - a) / 2;
        areas[i] += static_cast<double>(normal.dot(mesh.normals[mesh.triangles[t]]));
      }
    }
    EXPECT_NEAR(areas[0], areas[1], 1e-5);
    EXPECT_GT(areas[0], 0.01);
  }
}

TEST(PolygonModel, TheObjNamesEveryVertexAndFace) {
  const std::string obj = to_obj(polygon_model(ObjectKind::box, {0.2, 0.1, 0.4}));
  EXPECT_EQ(std::count(obj.begin(), obj.end(), 'v'), 8);
  EXPECT_EQ(std::count(obj.begin(), obj.end(), 'f'), 6);
  EXPECT_NE(obj.find("v -0.1 -0.05 -0.2\n"), std::string::npos) << obj;
}

}  // namespace
}  // namespace counterpart::stage
