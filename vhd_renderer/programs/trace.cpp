#include "vhd_renderer/programs/trace.hpp"

#include <cmath>

#include "vhd_renderer/motion/anatomy.hpp"

namespace counterpart {
namespace {

using nlohmann::json;

// Skin that goes at least half with a joint.
std::vector<std::pair<std::size_t, std::size_t>> skin_of(const Figure& figure, int joint) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t p = 0; p < figure.parts.size(); ++p) {
    const FigurePart& part = figure.parts[p];
    for (std::size_t v = 0; v < part.positions_m.size(); ++v) {
      float weight = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        if (part.joints[v][k] == joint) weight += part.weights[v][k];
      }
      if (weight >= 0.5F) found.emplace_back(p, v);
    }
  }
  return found;
}

// Metres to a hundredth of a millimetre: there are many of them.
double rounded(float metres) {
  return std::round(1e5 * static_cast<double>(metres)) / 1e5;
}

json place_of(const std::string& name, const Eigen::Vector3f& p) {
  return {{"name", name}, {"x", rounded(p.x())}, {"y", rounded(p.y())}, {"z", rounded(p.z())}};
}

}  // namespace

Trace::Trace(const Figure& figure, const Director& director) : figure_(figure), director_(director) {
  const auto anatomy = anatomy_of(figure);
  if (!anatomy) return;
  for (const std::size_t s : {left_side, right_side}) {
    for (const std::size_t f : {thumb, index_finger, middle_finger}) {
      const Finger& finger = anatomy->arms[s].hand.fingers[f];
      const std::string& first = figure.joints[static_cast<std::size_t>(finger.joint[0])].name;  // "l_thumb1"
      fingertips_.push_back({first.substr(0, first.size() - 1), skin_of(figure, finger.joint[2])});
    }
  }
}

json Trace::line(std::int64_t frame, std::int64_t now_ns, const Performance& p) {
  json joints = json::array();
  for (std::size_t j = 0; j < p.X_BJ.size(); ++j) {
    joints.push_back(place_of(figure_.joints[j].name, p.X_BJ[j].translation()));
  }
  json pieces = json::array();
  for (const StagedPiece& piece : p.pieces) pieces.push_back(place_of(piece.name, piece.X_BP.translation()));
  json fingertips = json::object();
  if (!fingertips_.empty()) skin(figure_, director_.morph_names(), p, skinned_);
  for (const Fingertip& tip : fingertips_) {
    json places = json::array();
    for (const auto& [part, vertex] : tip.skin) {
      const Eigen::Vector3f& place = skinned_[part].positions_m[vertex];
      places.push_back({rounded(place.x()), rounded(place.y()), rounded(place.z())});
    }
    fingertips[tip.name] = std::move(places);
  }
  return {{"frame", frame},
          {"t", 1e-9 * static_cast<double>(now_ns)},
          {"joints", std::move(joints)},
          {"pieces", std::move(pieces)},
          {"fingertips", std::move(fingertips)}};
}

}  // namespace counterpart
