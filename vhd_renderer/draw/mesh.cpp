#include "vhd_renderer/draw/mesh.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace counterpart {
namespace {

void add_quad(MeshData& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.insert(mesh.triangles.end(), {a, b, c, a, c, d});
}

}  // namespace

MeshData box_mesh(const Eigen::Vector3f& size_m) {
  MeshData mesh;
  const Eigen::Vector3f half = size_m / 2;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.f, 1.f}) {
      Eigen::Vector3f normal = Eigen::Vector3f::Zero();
      normal[axis] = sign;
      const Eigen::Vector3f right = axis == 2 ? Eigen::Vector3f(1, 0, 0) : Eigen::Vector3f(0, 0, 1).cross(normal);
      const Eigen::Vector3f up = normal.cross(right);
      const auto first = static_cast<std::uint32_t>(mesh.positions_m.size());
      for (const auto& [u, v] : {std::pair{-1.f, -1.f}, {1.f, -1.f}, {1.f, 1.f}, {-1.f, 1.f}}) {
        mesh.positions_m.push_back((normal + u * right + v * up).cwiseProduct(half));
        mesh.normals.push_back(normal);
        mesh.uvs.emplace_back((u + 1) / 2, (1 - v) / 2);
      }
      add_quad(mesh, first, first + 1, first + 2, first + 3);
    }
  }
  return mesh;
}

MeshData plane_mesh(float size_x_m, float size_y_m, int cells_x, int cells_y) {
  MeshData mesh;
  for (int row = 0; row <= cells_y; ++row) {
    for (int col = 0; col <= cells_x; ++col) {
      const float u = static_cast<float>(col) / static_cast<float>(cells_x);
      const float w = static_cast<float>(row) / static_cast<float>(cells_y);
      mesh.positions_m.emplace_back((u - 0.5f) * size_x_m, (w - 0.5f) * size_y_m, 0.f);
      mesh.normals.emplace_back(0.f, 0.f, 1.f);
      mesh.uvs.emplace_back(u, 1 - w);
    }
  }
  for (int row = 0; row < cells_y; ++row) {
    for (int col = 0; col < cells_x; ++col) {
      const auto a = static_cast<std::uint32_t>(row * (cells_x + 1) + col);
      const auto above = a + static_cast<std::uint32_t>(cells_x) + 1;
      add_quad(mesh, a, a + 1, above + 1, above);
    }
  }
  return mesh;
}

MeshData lathe_mesh(const std::vector<Eigen::Vector2f>& profile_m, int segments) {
  MeshData mesh;
  const std::size_t points = profile_m.size();
  // Outward normal of a profile step (dr, dz) is (dz, -dr).
  const auto step_normal = [&](std::size_t i) -> Eigen::Vector2f {
    const Eigen::Vector2f d = profile_m[i + 1] - profile_m[i];
    return d.norm() < 1e-9f ? Eigen::Vector2f(0, 0) : Eigen::Vector2f(d.y(), -d.x()).normalized();
  };
  constexpr float kPi = 3.14159265f;
  for (std::size_t i = 0; i < points; ++i) {
    const Eigen::Vector2f before = i > 0 ? step_normal(i - 1) : Eigen::Vector2f(0, 0);
    const Eigen::Vector2f after = i + 1 < points ? step_normal(i) : Eigen::Vector2f(0, 0);
    const Eigen::Vector2f n = (before + after).normalized();
    for (int s = 0; s <= segments; ++s) {
      const float angle = 2 * kPi * static_cast<float>(s) / static_cast<float>(segments);
      const float c = std::cos(angle);
      const float w = std::sin(angle);
      mesh.positions_m.emplace_back(profile_m[i].x() * c, profile_m[i].x() * w, profile_m[i].y());
      mesh.normals.emplace_back(n.x() * c, n.x() * w, n.y());
      mesh.uvs.emplace_back(static_cast<float>(s) / static_cast<float>(segments),
                            static_cast<float>(i) / static_cast<float>(points - 1));
    }
  }
  const auto ring = static_cast<std::uint32_t>(segments) + 1;
  for (std::size_t i = 0; i + 1 < points; ++i) {
    if ((profile_m[i + 1] - profile_m[i]).norm() < 1e-9f) continue;
    for (std::uint32_t s = 0; s < static_cast<std::uint32_t>(segments); ++s) {
      const auto a = static_cast<std::uint32_t>(i) * ring + s;
      if (profile_m[i].x() > 0) mesh.triangles.insert(mesh.triangles.end(), {a, a + 1, a + ring + 1});
      if (profile_m[i + 1].x() > 0) mesh.triangles.insert(mesh.triangles.end(), {a, a + ring + 1, a + ring});
    }
  }
  return mesh;
}

void append(MeshData& mesh, const MeshData& other, const Eigen::Vector3f& offset_m) {
  const auto first = static_cast<std::uint32_t>(mesh.positions_m.size());
  for (const Eigen::Vector3f& p : other.positions_m) mesh.positions_m.push_back(p + offset_m);
  mesh.normals.insert(mesh.normals.end(), other.normals.begin(), other.normals.end());
  mesh.uvs.insert(mesh.uvs.end(), other.uvs.begin(), other.uvs.end());
  for (const std::uint32_t index : other.triangles) mesh.triangles.push_back(first + index);
}

}  // namespace counterpart
