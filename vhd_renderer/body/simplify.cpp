#include "vhd_renderer/body/simplify.hpp"

#include <limits>

#include <meshoptimizer.h>

namespace counterpart {
namespace {

constexpr std::uint32_t gone = std::numeric_limits<std::uint32_t>::max();

template <class T>
void keep(std::vector<T>& of_vertices, const std::vector<std::uint32_t>& place, std::size_t count) {
  if (of_vertices.size() != place.size()) return;  // a part without it
  std::vector<T> kept(count);
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] != gone) kept[place[v]] = of_vertices[v];
  }
  of_vertices = std::move(kept);
}

Morph kept_morph(const Morph& whole, const std::vector<std::uint32_t>& place) {
  Morph morph;
  morph.name = whole.name;
  for (std::size_t i = 0; i < whole.vertices.size(); ++i) {
    const std::uint32_t v = place[whole.vertices[i]];
    if (v == gone) continue;
    morph.vertices.push_back(v);
    morph.offsets_m.push_back(whole.offsets_m[i]);
  }
  return morph;
}

FigurePart simplified(const FigurePart& whole, float error_m) {
  const std::size_t count = whole.positions_m.size();
  if (count == 0 || whole.triangles.empty()) return whole;
  const float* positions = whole.positions_m.front().data();
  constexpr std::size_t stride = sizeof(Eigen::Vector3f);
  // meshoptimizer counts errors in shares of the mesh's extent.
  const float extent_m = meshopt_simplifyScale(positions, count, stride);
  if (!(extent_m > 0)) return whole;
  std::vector<std::uint32_t> triangles(whole.triangles.size());
  triangles.resize(meshopt_simplify(triangles.data(), whole.triangles.data(), whole.triangles.size(), positions, count,
                                    stride, 0, error_m / extent_m));
  if (triangles.empty() || triangles.size() == whole.triangles.size()) return whole;
  meshopt_optimizeVertexCache(triangles.data(), triangles.data(), triangles.size(), count);

  FigurePart part = whole;
  std::vector<std::uint32_t> place(count);
  const std::size_t kept = meshopt_optimizeVertexFetchRemap(place.data(), triangles.data(), triangles.size(), count);
  for (std::uint32_t& v : triangles) v = place[v];
  part.triangles = std::move(triangles);
  keep(part.positions_m, place, kept);
  keep(part.normals, place, kept);
  keep(part.uvs, place, kept);
  keep(part.joints, place, kept);
  keep(part.weights, place, kept);
  for (Morph& morph : part.morphs) morph = kept_morph(morph, place);
  return part;
}

}  // namespace

Figure simplified(const Figure& figure, float error_m) {
  Figure simple = figure;
  if (error_m <= 0) return simple;
  for (FigurePart& part : simple.parts) part = simplified(part, part.morphs.empty() ? error_m : error_m / 2);
  return simple;
}

}  // namespace counterpart
