#include "stage/room/polygon_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <Eigen/Geometry>

namespace counterpart::stage {
namespace {

// Corner c of a block: bit 0 says which side in x, bit 1 in y, bit 2 in z.
Eigen::Vector3d corner_O(const Block& block, int c) {
  const Eigen::Vector3d sign((c & 1) != 0 ? 0.5 : -0.5, (c & 2) != 0 ? 0.5 : -0.5, (c & 4) != 0 ? 0.5 : -0.5);
  return block.centre_O + block.size_m.cwiseProduct(sign);
}

constexpr std::array<std::array<int, 4>, 6> kSides{
    {{1, 3, 7, 5}, {2, 0, 4, 6}, {3, 2, 6, 7}, {0, 1, 5, 4}, {4, 5, 7, 6}, {2, 3, 1, 0}}};
constexpr std::size_t kTop = 4;
constexpr std::size_t kBottom = 5;

PolygonModel with_faces(std::vector<Block> blocks) {
  PolygonModel model;
  for (const Block& block : blocks) {
    const int first = static_cast<int>(model.vertices_O.size());
    for (int c = 0; c < 8; ++c) model.vertices_O.push_back(corner_O(block, c));
    for (std::size_t side = 0; side < kSides.size(); ++side) {
      if ((side == kTop && block.no_top) || (side == kBottom && block.no_bottom)) continue;
      std::vector<int> face;
      for (const int c : kSides[side]) face.push_back(first + c);
      model.faces.push_back(face);
    }
  }
  model.blocks = std::move(blocks);
  return model;
}

// Four legs under a plate whose underside is at `under_z_m`. They stand in from its edges, so that no two faces of the
// model lie in one plane.
void add_legs(std::vector<Block>& blocks, const Eigen::Vector3d& size_m, double under_z_m, double leg_m) {
  constexpr double kInset_m = 0.012;
  const double height = under_z_m + size_m.z() / 2;
  const Eigen::Vector2d place = (size_m.head<2>().array() - leg_m) / 2 - kInset_m;
  for (const double x : {-place.x(), place.x()}) {
    for (const double y : {-place.y(), place.y()}) {
      blocks.push_back({{x, y, -size_m.z() / 2 + height / 2}, {leg_m, leg_m, height}, true, false});
    }
  }
}

PolygonModel table_model(const Eigen::Vector3d& size_m) {
  constexpr double kPlate_m = 0.035;
  std::vector<Block> blocks{{{0, 0, size_m.z() / 2 - kPlate_m / 2}, {size_m.x(), size_m.y(), kPlate_m}}};
  add_legs(blocks, size_m, size_m.z() / 2 - kPlate_m, 0.05);
  return with_faces(std::move(blocks));
}

PolygonModel chair_model(const Eigen::Vector3d& size_m) {
  constexpr double kPlate_m = 0.04;
  constexpr double kBack_m = 0.03;
  constexpr double kInset_m = 0.015;
  const double seat_z = -size_m.z() / 2 + 0.5 * size_m.z();  // the seat is half as high as the chair
  const double back_height = size_m.z() / 2 - seat_z;
  std::vector<Block> blocks{{{0, 0, seat_z - kPlate_m / 2}, {size_m.x(), size_m.y(), kPlate_m}},
                            {{0, (size_m.y() - kBack_m) / 2 - kInset_m, seat_z + back_height / 2},
                             {size_m.x() - 2 * kInset_m, kBack_m, back_height},
                             false,
                             true}};
  add_legs(blocks, size_m, seat_z - kPlate_m, 0.04);
  return with_faces(std::move(blocks));
}

}  // namespace

Eigen::Vector3d usual_size_m(ObjectKind kind) {
  if (kind == ObjectKind::table) return {0.70, 0.50, 0.60};
  if (kind == ObjectKind::chair) return {0.42, 0.42, 0.90};
  return {0.20, 0.14, 0.10};
}

PolygonModel polygon_model(ObjectKind kind, const Eigen::Vector3d& size_m) {
  if (kind == ObjectKind::table) return table_model(size_m);
  if (kind == ObjectKind::chair) return chair_model(size_m);
  return with_faces({Block{{0, 0, 0}, size_m}});
}

std::string to_obj(const PolygonModel& model) {
  std::string text;
  char line[128];
  for (const Eigen::Vector3d& v : model.vertices_O) {
    std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", v.x(), v.y(), v.z());
    text += line;
  }
  for (const std::vector<int>& face : model.faces) {
    text += "f";
    for (const int index : face) text += " " + std::to_string(index + 1);
    text += "\n";
  }
  return text;
}

MeshData mesh_of(const PolygonModel& model, double cell_m) {
  MeshData mesh;
  for (const std::vector<int>& face : model.faces) {
    const auto at = [&](std::size_t i) { return model.vertices_O[static_cast<std::size_t>(face[i])]; };
    const Eigen::Vector3d u = at(1) - at(0);
    const Eigen::Vector3d v = at(3) - at(0);
    const int cells_u = std::max(1, static_cast<int>(std::ceil(u.norm() / cell_m)));
    const int cells_v = std::max(1, static_cast<int>(std::ceil(v.norm() / cell_m)));
    const auto first = static_cast<std::uint32_t>(mesh.positions_m.size());
    const Eigen::Vector3f normal = u.cross(v).normalized().cast<float>();
    for (int j = 0; j <= cells_v; ++j) {
      for (int i = 0; i <= cells_u; ++i) {
        const double s = static_cast<double>(i) / cells_u;
        const double t = static_cast<double>(j) / cells_v;
        mesh.positions_m.push_back((at(0) + s * u + t * v).cast<float>());
        mesh.normals.push_back(normal);
        mesh.uvs.emplace_back(static_cast<float>(2 * s * u.norm()), static_cast<float>(2 * t * v.norm()));
      }
    }
    const auto row = static_cast<std::uint32_t>(cells_u + 1);
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(cells_v); ++j) {
      for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(cells_u); ++i) {
        const std::uint32_t a = first + j * row + i;
        mesh.triangles.insert(mesh.triangles.end(), {a, a + 1, a + row + 1, a, a + row + 1, a + row});
      }
    }
  }
  return mesh;
}

bool comes_between(const PolygonModel& model, const Eigen::Vector3d& a_O, const Eigen::Vector3d& b_O) {
  constexpr double kSkin_m = 1e-4;
  return std::any_of(model.blocks.begin(), model.blocks.end(), [&](const Block& block) {
    double enter = 0, leave = 1;  // where along the way it is inside the block's slabs
    for (int axis = 0; axis < 3; ++axis) {
      const double half = block.size_m[axis] / 2 - kSkin_m;
      const double from = a_O[axis] - block.centre_O[axis];
      const double way = b_O[axis] - a_O[axis];
      if (std::abs(way) < 1e-12) {
        if (std::abs(from) >= half) return false;
        continue;
      }
      const double first = (-half - from) / way;
      const double second = (half - from) / way;
      enter = std::max(enter, std::min(first, second));
      leave = std::min(leave, std::max(first, second));
    }
    return enter < leave;
  });
}

}  // namespace counterpart::stage
