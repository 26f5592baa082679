#include "stage/room/blend_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include <Eigen/Geometry>

namespace counterpart::stage {
namespace {

float smooth_union(const std::vector<Capsule>& capsules, const Eigen::Vector3f& p, float blend) {
  float result = 1e3f;
  for (const Capsule& capsule : capsules) {
    const float d = distance_m(capsule, p);
    const float h = std::max(blend - std::abs(result - d), 0.f) / blend;
    result = std::min(result, d) - h * h * blend * 0.25f;
  }
  return result;
}

struct Grid {
  Eigen::Vector3f origin;
  float cell;
  std::array<int, 3> size;
  std::vector<float> values;

  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size[1]) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size[0]) +
           static_cast<std::size_t>(x);
  }
  Eigen::Vector3f place(int x, int y, int z) const {
    return origin + cell * Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  }
};

Grid sampled(const std::vector<Capsule>& capsules, float blend, float cell) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e3f);
  Eigen::Vector3f high = -low;
  for (const Capsule& c : capsules) {
    const float margin = std::max(c.radius_a_m, c.radius_b_m) + blend + 2 * cell;
    low = low.cwiseMin(c.a_m.cwiseMin(c.b_m) - Eigen::Vector3f::Constant(margin));
    high = high.cwiseMax(c.a_m.cwiseMax(c.b_m) + Eigen::Vector3f::Constant(margin));
  }
  Grid grid{low, cell, {}, {}};
  for (int i = 0; i < 3; ++i) grid.size[static_cast<std::size_t>(i)] = static_cast<int>((high[i] - low[i]) / cell) + 2;
  for (int z = 0; z < grid.size[2]; ++z) {
    for (int y = 0; y < grid.size[1]; ++y) {
      for (int x = 0; x < grid.size[0]; ++x) grid.values.push_back(smooth_union(capsules, grid.place(x, y, z), blend));
    }
  }
  return grid;
}

// The mean of the points where the cell's edges cross the surface; false if none does.
bool cell_vertex(const Grid& grid, int x, int y, int z, Eigen::Vector3f& vertex) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  int crossings = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int other = 0; other < 4; ++other) {
      std::array<int, 3> a{x, y, z};
      a[static_cast<std::size_t>((axis + 1) % 3)] += other & 1;
      a[static_cast<std::size_t>((axis + 2) % 3)] += other >> 1;
      std::array<int, 3> b = a;
      b[static_cast<std::size_t>(axis)] += 1;
      const float va = grid.values[grid.index(a[0], a[1], a[2])];
      const float vb = grid.values[grid.index(b[0], b[1], b[2])];
      if ((va < 0) == (vb < 0)) continue;
      const float t = va / (va - vb);
      sum += grid.place(a[0], a[1], a[2]) * (1 - t) + grid.place(b[0], b[1], b[2]) * t;
      ++crossings;
    }
  }
  if (crossings == 0) return false;
  vertex = sum / static_cast<float>(crossings);
  return true;
}

}  // namespace

Capsule moved(const Capsule& c, const Eigen::Isometry3f& X) {
  return {X * c.a_m, X * c.b_m, c.radius_a_m, c.radius_b_m};
}

float distance_m(const Capsule& capsule, const Eigen::Vector3f& p) {
  const Eigen::Vector3f axis = capsule.b_m - capsule.a_m;
  const float t = std::clamp((p - capsule.a_m).dot(axis) / std::max(axis.squaredNorm(), 1e-12f), 0.f, 1.f);
  return (p - capsule.a_m - t * axis).norm() - (capsule.radius_a_m + t * (capsule.radius_b_m - capsule.radius_a_m));
}

MeshData blended(const std::vector<Capsule>& capsules, float blend_m, float cell_m) {
  const Grid grid = sampled(capsules, blend_m, cell_m);
  MeshData mesh;
  std::unordered_map<std::size_t, std::uint32_t> vertex_of_cell;
  for (int z = 0; z + 1 < grid.size[2]; ++z) {
    for (int y = 0; y + 1 < grid.size[1]; ++y) {
      for (int x = 0; x + 1 < grid.size[0]; ++x) {
        Eigen::Vector3f p;
        if (!cell_vertex(grid, x, y, z, p)) continue;
        vertex_of_cell[grid.index(x, y, z)] = static_cast<std::uint32_t>(mesh.positions_m.size());
        Eigen::Vector3f gradient;
        for (int i = 0; i < 3; ++i) {
          const Eigen::Vector3f step = Eigen::Vector3f::Unit(i) * cell_m * 0.5f;
          gradient[i] = smooth_union(capsules, p + step, blend_m) - smooth_union(capsules, p - step, blend_m);
        }
        mesh.positions_m.push_back(p);
        mesh.normals.push_back(gradient.normalized());
        mesh.uvs.emplace_back(p.x(), p.y());
      }
    }
  }
  // A quad round every grid edge that crosses the surface.
  for (int z = 1; z + 1 < grid.size[2]; ++z) {
    for (int y = 1; y + 1 < grid.size[1]; ++y) {
      for (int x = 1; x + 1 < grid.size[0]; ++x) {
        const bool inside = grid.values[grid.index(x, y, z)] < 0;
        for (int axis = 0; axis < 3; ++axis) {
          std::array<int, 3> next{x, y, z};
          next[static_cast<std::size_t>(axis)] += 1;
          if ((grid.values[grid.index(next[0], next[1], next[2])] < 0) == inside) continue;
          std::array<std::uint32_t, 4> quad{};
          for (std::size_t corner = 0; corner < 4; ++corner) {
            std::array<int, 3> cell{x, y, z};
            if (corner == 1 || corner == 2) cell[static_cast<std::size_t>((axis + 1) % 3)] -= 1;
            if (corner >= 2) cell[static_cast<std::size_t>((axis + 2) % 3)] -= 1;
            quad[corner] = vertex_of_cell.at(grid.index(cell[0], cell[1], cell[2]));
          }
          if (!inside) std::swap(quad[1], quad[3]);
          mesh.triangles.insert(mesh.triangles.end(), {quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]});
        }
      }
    }
  }
  return mesh;
}

}  // namespace counterpart::stage
