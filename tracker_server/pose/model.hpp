// What is tracked: straight edges in space and the faces that may hide them.
#pragma once

#include <filesystem>
#include <vector>

#include <Eigen/Core>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// A straight edge from a to b, model frame M, metres.
struct ModelSegment {
  Eigen::Vector3d a_M, b_M;
  // +1: the picture is brighter on the right of a -> b as it is seen; -1: darker; 0: not known, learned while tracking.
  int polarity = 0;
  // Faces that meet here, -1 for none. An edge whose faces all look away is not seen; one without faces always is.
  int face0 = -1, face1 = -1;
  bool outline = false;  // on a board: what lies on its other side is not part of the model
};

struct ModelFace {
  std::vector<Eigen::Vector3d> corners_M;  // counterclockwise seen from outside
  Eigen::Vector3d normal_M;                // unit, outward
};

struct Model {
  std::vector<ModelSegment> segments;
  std::vector<ModelFace> faces;
  double size_m = 0;  // largest extent
  // For each segment those beside it, which what lies over it mostly lies over, too. Empty where that is not known.
  std::vector<std::vector<int>> beside;
};

// The playing surface with every line of its grid; frame B.
Model board_model(const BoardGeometry& board);

// A Wavefront OBJ with faces `f` (outward) and extra lines `l`. Edges between faces that lie in one plane are left out.
// Names the line at fault; at most 20,000 faces and lines.
[[nodiscard]] Result<Model> read_obj_model(const std::filesystem::path& path);

}  // namespace counterpart
