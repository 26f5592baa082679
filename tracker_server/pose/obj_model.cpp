#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <Eigen/Geometry>

#include "tracker_server/pose/model.hpp"

namespace counterpart {
namespace {

constexpr std::size_t most_elements = 20000;

// The vertex index before the first slash, 1-based or negative from the end; -1 if it names no vertex.
long vertex_index(const std::string& word, std::size_t vertices) {
  char* end = nullptr;
  const long number = std::strtol(word.c_str(), &end, 10);
  if (end == word.c_str() || (*end != '\0' && *end != '/')) return -1;
  const long count = static_cast<long>(vertices);
  const long index = number > 0 ? number - 1 : count + number;
  return number != 0 && index >= 0 && index < count ? index : -1;
}

// By Newell's method, so that polygons need not be exactly flat.
Eigen::Vector3d normal_of(const std::vector<Eigen::Vector3d>& corners) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) normal += corners[i].cross(corners[(i + 1) % corners.size()]);
  return normal;
}

}  // namespace

Result<Model> read_obj_model(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return failure(ErrorCode::not_found, "Cannot open the model " + path.string() + ".");

  Model model;
  std::vector<Eigen::Vector3d> vertices;
  std::map<std::pair<long, long>, std::pair<int, int>> edges;  // ends to the one or two faces that meet there
  std::map<std::pair<long, long>, bool> lines;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    const auto bad = [&](const std::string& why) {
      return failure(ErrorCode::bad_format, path.string() + ", line " + std::to_string(number) + ": " + why + ".");
    };
    std::istringstream words(text);
    std::string kind;
    if (!(words >> kind) || kind[0] == '#') continue;
    if (kind == "v") {
      Eigen::Vector3d v;
      if (!(words >> v.x() >> v.y() >> v.z()) || !v.allFinite()) return bad("a vertex needs three finite numbers");
      vertices.push_back(v);
    } else if (kind == "f" || kind == "l") {
      std::vector<long> indices;
      for (std::string word; words >> word;) {
        const long index = vertex_index(word, vertices.size());
        if (index < 0) return bad("\"" + word + "\" is not a vertex that was given before");
        indices.push_back(index);
      }
      if (kind == "l") {
        if (indices.size() < 2) return bad("a line needs two vertices");
        for (std::size_t i = 0; i + 1 < indices.size(); ++i) {
          if (indices[i] == indices[i + 1]) return bad("a line from a vertex to itself");
          lines[std::minmax(indices[i], indices[i + 1])] = true;
        }
      } else {
        if (indices.size() < 3) return bad("a face needs three vertices");
        ModelFace face;
        for (long index : indices) face.corners_M.push_back(vertices[static_cast<std::size_t>(index)]);
        const Eigen::Vector3d normal = normal_of(face.corners_M);
        if (!(normal.norm() > 1e-12)) return bad("the face has no area");
        face.normal_M = normal.normalized();
        const int id = static_cast<int>(model.faces.size());
        model.faces.push_back(face);
        for (std::size_t i = 0; i < indices.size(); ++i) {
          const auto ends = std::minmax(indices[i], indices[(i + 1) % indices.size()]);
          if (ends.first == ends.second) return bad("the face names a vertex twice");
          const auto [edge, fresh] = edges.try_emplace(ends, id, -1);
          if (!fresh && edge->second.second < 0) edge->second.second = id;
        }
      }
    }
    if (model.faces.size() + lines.size() > most_elements) return bad("more than 20,000 faces and lines");
  }

  const auto vertex = [&](long i) { return vertices[static_cast<std::size_t>(i)]; };
  for (const auto& [ends, faces] : edges) {
    const auto& [face0, face1] = faces;
    const bool flat = face1 >= 0 && model.faces[static_cast<std::size_t>(face0)].normal_M.dot(
                                        model.faces[static_cast<std::size_t>(face1)].normal_M) > 0.9998;
    const bool drawn = lines.erase(ends) > 0;
    if (flat && !drawn) continue;
    model.segments.push_back({vertex(ends.first), vertex(ends.second), 0, face0, face1});
  }
  // A drawn line belongs to the faces it lies in.
  for (const auto& [ends, drawn] : lines) {
    ModelSegment segment{vertex(ends.first), vertex(ends.second)};
    for (std::size_t i = 0; i < model.faces.size(); ++i) {
      const ModelFace& face = model.faces[i];
      const double size = (face.corners_M[1] - face.corners_M[0]).norm();
      const auto off = [&](const Eigen::Vector3d& p) { return std::abs(face.normal_M.dot(p - face.corners_M[0])); };
      if (off(segment.a_M) > 1e-4 * size || off(segment.b_M) > 1e-4 * size) continue;
      (segment.face0 < 0 ? segment.face0 : segment.face1) = static_cast<int>(i);
      if (segment.face1 >= 0) break;
    }
    model.segments.push_back(segment);
  }
  if (model.segments.empty())
    return failure(ErrorCode::bad_format, path.string() + " holds no face (f) and no line (l) to track.");

  Eigen::Vector3d low = vertices[0], high = vertices[0];
  for (const auto& segment : model.segments)
    for (const auto& p : {segment.a_M, segment.b_M}) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  model.size_m = (high - low).maxCoeff();
  return model;
}

}  // namespace counterpart
