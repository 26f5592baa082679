#include <algorithm>
#include <set>

#include "vhd_renderer/motion/director.hpp"

namespace counterpart {
namespace {

using Eigen::Matrix4f;
using Eigen::Vector3f;
using Eigen::Vector4f;

// Positions at bind with the face shapes that are at work.
void add_morphs(const FigurePart& part, const std::vector<std::string>& names, const std::vector<float>& weights,
                std::vector<Vector3f>& positions) {
  for (const Morph& morph : part.morphs) {
    const auto at = std::lower_bound(names.begin(), names.end(), morph.name);
    if (at == names.end() || *at != morph.name) continue;
    const auto index = static_cast<std::size_t>(at - names.begin());
    if (index >= weights.size() || weights[index] < 1e-3F) continue;
    for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
      positions[morph.vertices[i]] += weights[index] * morph.offsets_m[i];
    }
  }
}

void skin_part(const FigurePart& part, const std::vector<Matrix4f>& M, SkinnedPart& out) {
  const std::size_t n = part.positions_m.size();
  for (std::size_t v = 0; v < n; ++v) {
    const auto& joints = part.joints[v];
    const auto& weights = part.weights[v];
    Matrix4f blend = M[joints[0]];
    if (weights[0] < 0.999F) {
      blend *= weights[0];
      for (std::size_t k = 1; k < 4 && weights[k] > 0; ++k) blend += weights[k] * M[joints[k]];
    }
    const Vector3f& p = out.positions_m[v];
    const Vector3f& m = part.normals[v];
    out.positions_m[v] = (blend.col(0) * p.x() + blend.col(1) * p.y() + blend.col(2) * p.z() + blend.col(3)).head<3>();
    const Vector4f normal = blend.col(0) * m.x() + blend.col(1) * m.y() + blend.col(2) * m.z();
    out.normals[v] = normal.head<3>().normalized();
  }
}

}  // namespace

std::vector<std::string> morph_names_of(const Figure& figure) {
  std::set<std::string> names;
  for (const FigurePart& part : figure.parts) {
    for (const Morph& morph : part.morphs) names.insert(morph.name);
  }
  return {names.begin(), names.end()};
}

void skin(const Figure& figure, const std::vector<std::string>& morph_names, const Performance& performance,
          std::vector<SkinnedPart>& parts) {
  std::vector<Matrix4f> M(figure.joints.size(), Matrix4f::Identity());
  for (std::size_t j = 0; j < std::min(M.size(), performance.X_BJ.size()); ++j) {
    M[j] = (performance.X_BJ[j] * figure.joints[j].X_HJ.inverse()).matrix();
  }
  parts.resize(figure.parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const FigurePart& part = figure.parts[i];
    parts[i].positions_m = part.positions_m;
    parts[i].normals.resize(part.normals.size());
    add_morphs(part, morph_names, performance.morphs, parts[i].positions_m);
    skin_part(part, M, parts[i]);
  }
}

}  // namespace counterpart
