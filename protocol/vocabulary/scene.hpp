// Everything virtual that is not the human, and what stands for real things. A snapshot; all in the board frame B.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/game.hpp"

namespace counterpart {

struct ScenePiece {
  std::string name;  // stable while the piece lives, e.g. "light_31" after its first square
  Side side = Side::light;
  bool king = false;
  bool real = false;  // true: a copy of a real piece, drawn only to hide what is behind it
  Point3 p_B{};       // centre of its foot, metres

  friend bool operator==(const ScenePiece&, const ScenePiece&) = default;
};

// A real thing that hides virtual ones.
struct SceneBox {
  std::string name;  // "table", ...
  Pose X_BO;         // the box's own frame O, origin at its centre
  Point3 size_m{};   // full lengths along O's axes

  friend bool operator==(const SceneBox&, const SceneBox&) = default;
};

struct SceneLight {
  Point3 direction_B{0.3, 0.4, 0.85};  // towards the light
  Point3 colour{1, 1, 1};              // linear, 1 = a white surface facing it is white
  Point3 ambient{0.35, 0.35, 0.38};

  friend bool operator==(const SceneLight&, const SceneLight&) = default;
};

struct Scene {
  std::uint64_t revision = 0;
  BoardGeometry board;
  double table_height_m = 0.74;  // of the board's playing surface above the floor
  std::vector<ScenePiece> pieces;
  std::vector<SceneBox> boxes;
  SceneLight light;
  Side virtual_side = Side::light;   // where the human sits: light at -y, dark at +y
  std::string opponent = "default";  // which human

  friend bool operator==(const Scene&, const Scene&) = default;
};

}  // namespace counterpart
