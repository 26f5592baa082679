// A human as data: skeleton, skinned meshes, textures. Metres; the figure stands on z = 0 at the origin of its own
// frame H, looks along +y, left is -x. (The loader turns glTF's y-up axes into this, in one place.)
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace counterpart {

struct Texture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  // rows from the top
};

enum class AlphaMode : std::uint8_t { opaque = 1, cutout = 2 };

// One morph target: offsets of some vertices.
struct Morph {
  std::string name;
  std::vector<std::uint32_t> vertices;
  std::vector<Eigen::Vector3f> offsets_m;
};

struct FigurePart {
  std::string name;
  std::vector<Eigen::Vector3f> positions_m;          // in H, at bind
  std::vector<Eigen::Vector3f> normals;              // unit
  std::vector<Eigen::Vector2f> uvs;                  // v = 0 at the top row of the texture
  std::vector<std::uint32_t> triangles;              // three indices each, counter-clockwise from outside
  std::vector<std::array<std::uint16_t, 4>> joints;  // of the skeleton, by vertex
  std::vector<std::array<float, 4>> weights;         // sum 1
  std::vector<Morph> morphs;
  int texture = -1;                 // index into Figure::textures, -1: colour alone
  Eigen::Vector3f colour{1, 1, 1};  // linear, multiplies the texture
  AlphaMode alpha = AlphaMode::opaque;
  bool double_sided = false;
};

struct Joint {
  std::string name;  // H-Anim 1.1 where it has one ("r_wrist"), the source's own otherwise
  int parent = -1;   // smaller than the joint's own index; -1 for the root
  Eigen::Isometry3f X_PJ = Eigen::Isometry3f::Identity();  // bind pose in the parent
  Eigen::Isometry3f X_HJ = Eigen::Isometry3f::Identity();  // bind pose in H
};

struct Figure {
  std::string name;
  std::vector<Joint> joints;
  std::vector<FigurePart> parts;
  std::vector<Texture> textures;
};

}  // namespace counterpart
