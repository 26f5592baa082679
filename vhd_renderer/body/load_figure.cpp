#include "vhd_renderer/body/load_figure.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <unordered_map>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "vhd_renderer/body/axes.hpp"
#include "vhd_renderer/body/decode_texture.hpp"
#include "vhd_renderer/body/joint_names.hpp"

namespace counterpart {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_file = 512ULL << 20U;
constexpr std::size_t most_joints = 1024;
constexpr std::size_t most_vertices = 4'000'000;

tl::unexpected<Error> bad(const fs::path& path, const std::string& why) {
  return failure(ErrorCode::bad_format, "the figure " + path.string() + " cannot be used: " + why);
}

Eigen::Affine3f affine(const aiMatrix4x4& m) {
  Eigen::Affine3f A = Eigen::Affine3f::Identity();
  A.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return A;
}

Eigen::Vector3f point(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

// assimp reads beyond a cut GLB's end without a word in some places, so its own header is asked first.
Result<void> check_file(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return failure(ErrorCode::not_found, "there is no figure " + path.string());
  if (size > largest_file) return failure(ErrorCode::limit_exceeded, "the figure " + path.string() + " is over 512 MB");
  std::ifstream in(path, std::ios::binary);
  unsigned char h[12] = {};
  in.read(reinterpret_cast<char*>(h), 12);
  const bool glb = in.gcount() == 12 && h[0] == 'g' && h[1] == 'l' && h[2] == 'T' && h[3] == 'F';
  if (!glb) return path.extension() == ".glb" ? Result<void>(bad(path, "it is no GLB file")) : Result<void>();
  const std::uint32_t announced = static_cast<std::uint32_t>(h[8]) | (static_cast<std::uint32_t>(h[9]) << 8U) |
                                  (static_cast<std::uint32_t>(h[10]) << 16U) |
                                  (static_cast<std::uint32_t>(h[11]) << 24U);
  if (announced > size) {
    return bad(path, "it is cut off after " + std::to_string(size) + " of " + std::to_string(announced) + " bytes");
  }
  return {};
}

struct Node {
  const aiNode* node = nullptr;
  int parent = -1;  // among the nodes kept
  Eigen::Affine3f global = Eigen::Affine3f::Identity();
};

// Bones, what hangs below them, and what leads to them.
std::vector<Node> skeleton_nodes(const aiScene& scene) {
  std::unordered_map<std::string, bool> is_bone;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    for (unsigned b = 0; b < scene.mMeshes[m]->mNumBones; ++b)
      is_bone[scene.mMeshes[m]->mBones[b]->mName.C_Str()] = true;
  }
  std::vector<Node> kept;
  const std::function<bool(const aiNode&)> leads_to_bone = [&](const aiNode& node) {
    if (is_bone.count(node.mName.C_Str()) > 0) return true;
    for (unsigned c = 0; c < node.mNumChildren; ++c) {
      if (leads_to_bone(*node.mChildren[c])) return true;
    }
    return false;
  };
  const std::function<void(const aiNode&, int, const Eigen::Affine3f&, bool, int)> walk =
      [&](const aiNode& node, int parent, const Eigen::Affine3f& above, bool below_bone, int depth) {
        const Eigen::Affine3f global = above * affine(node.mTransformation);
        const bool bone = is_bone.count(node.mName.C_Str()) > 0;
        // The root of a skeleton moves no vertex itself, so no mesh names it as a bone.
        const bool above_bone = depth > 0 && node.mNumMeshes == 0 && leads_to_bone(node);
        const bool keep = bone || above_bone || (below_bone && node.mNumMeshes == 0);
        if (keep) kept.push_back({&node, parent, global});
        const int own = keep ? static_cast<int>(kept.size()) - 1 : parent;
        if (depth > 500 || kept.size() > most_joints) return;
        for (unsigned c = 0; c < node.mNumChildren; ++c) {
          const aiNode& child = *node.mChildren[c];
          if (keep || leads_to_bone(child)) walk(child, own, global, bone || below_bone, depth + 1);
        }
      };
  if (scene.mRootNode != nullptr) walk(*scene.mRootNode, -1, Eigen::Affine3f::Identity(), false, 0);
  return kept;
}

using Influences = std::vector<std::vector<std::pair<float, std::uint16_t>>>;

struct Skin {
  Influences influences;               // by vertex
  std::vector<Eigen::Affine3f> blend;  // by vertex: mesh coordinates to the pose stored in the file
};

Skin skin_of(const aiMesh& mesh, const std::vector<Node>& nodes,
             const std::unordered_map<std::string, std::uint16_t>& index) {
  Skin skin{Influences(mesh.mNumVertices), std::vector<Eigen::Affine3f>(mesh.mNumVertices)};
  std::vector<Eigen::Matrix4f> sums(mesh.mNumVertices, Eigen::Matrix4f::Zero());
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const auto joint = index.find(bone.mName.C_Str());
    if (joint == index.end()) continue;
    const Eigen::Matrix4f M = (nodes[joint->second].global * affine(bone.mOffsetMatrix)).matrix();
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& weight = bone.mWeights[w];
      if (weight.mVertexId >= mesh.mNumVertices || !(weight.mWeight > 0)) continue;
      skin.influences[weight.mVertexId].emplace_back(weight.mWeight, joint->second);
      sums[weight.mVertexId] += weight.mWeight * M;
    }
  }
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    float sum = 0;
    for (const auto& one : skin.influences[v]) sum += one.first;
    skin.blend[v] = sum > 0 ? Eigen::Affine3f(sums[v] / sum) : Eigen::Affine3f::Identity();
  }
  return skin;
}

void set_weights(const Influences& influences, FigurePart& part) {
  for (auto all : influences) {
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::array<std::uint16_t, 4> joints{};
    std::array<float, 4> weights{};
    float sum = 0;
    for (std::size_t k = 0; k < std::min<std::size_t>(4, all.size()); ++k) {
      weights[k] = all[k].first;
      joints[k] = all[k].second;
      sum += weights[k];
    }
    if (!(sum > 0)) weights[0] = sum = 1;
    for (float& w : weights) w /= sum;
    part.joints.push_back(joints);
    part.weights.push_back(weights);
  }
}

FigurePart part_of(const aiMesh& mesh, const std::vector<Node>& nodes,
                   const std::unordered_map<std::string, std::uint16_t>& index) {
  FigurePart part;
  part.name = mesh.mName.C_Str();
  const Skin skin = skin_of(mesh, nodes, index);
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    part.positions_m.push_back(H_from_y_up(skin.blend[v] * point(mesh.mVertices[v])));
    const Eigen::Vector3f n = mesh.HasNormals() ? point(mesh.mNormals[v]) : Eigen::Vector3f::UnitY();
    part.normals.push_back(H_from_y_up((skin.blend[v].linear() * n).normalized()));
    // assimp's v runs upwards.
    const bool uv = mesh.HasTextureCoords(0);
    part.uvs.emplace_back(uv ? mesh.mTextureCoords[0][v].x : 0, uv ? 1 - mesh.mTextureCoords[0][v].y : 0);
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    for (unsigned k = 0; k < 3; ++k) part.triangles.push_back(face.mIndices[k]);
  }
  set_weights(skin.influences, part);
  for (unsigned a = 0; a < mesh.mNumAnimMeshes; ++a) {
    const aiAnimMesh& shape = *mesh.mAnimMeshes[a];
    if (shape.mVertices == nullptr || shape.mNumVertices != mesh.mNumVertices) continue;
    Morph morph;
    morph.name = shape.mName.length > 0 ? shape.mName.C_Str() : "shape" + std::to_string(a);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const Eigen::Vector3f offset = skin.blend[v].linear() * (point(shape.mVertices[v]) - point(mesh.mVertices[v]));
      if (offset.norm() < 1e-5F) continue;
      morph.vertices.push_back(v);
      morph.offsets_m.push_back(H_from_y_up(offset));
    }
    if (!morph.vertices.empty()) part.morphs.push_back(std::move(morph));
  }
  return part;
}

Result<Texture> texture_named(const aiScene& scene, const aiString& name, const fs::path& folder) {
  if (const aiTexture* inside = scene.GetEmbeddedTexture(name.C_Str()); inside != nullptr) {
    if (inside->mHeight == 0) {
      return decode_texture({reinterpret_cast<const unsigned char*>(inside->pcData), inside->mWidth});
    }
    Texture texture{static_cast<int>(inside->mWidth), static_cast<int>(inside->mHeight), {}};
    for (std::size_t i = 0; i < static_cast<std::size_t>(inside->mWidth) * inside->mHeight; ++i) {
      const aiTexel& t = inside->pcData[i];
      texture.rgba.insert(texture.rgba.end(), {t.r, t.g, t.b, t.a});
    }
    return texture;
  }
  // Only beside the figure: a file must not make us read elsewhere.
  return read_texture(folder / fs::path(name.C_Str()).filename());
}

void set_material(const aiScene& scene, const aiMesh& mesh, const fs::path& folder,
                  std::unordered_map<std::string, int>& known, Figure& figure, FigurePart& part) {
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return;
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  aiColor4D colour(1, 1, 1, 1);
  if (material.Get(AI_MATKEY_BASE_COLOR, colour) == AI_SUCCESS ||
      material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == AI_SUCCESS) {
    part.colour = {colour.r, colour.g, colour.b};
  }
  int two_sided = 0;
  part.double_sided = material.Get(AI_MATKEY_TWOSIDED, two_sided) == AI_SUCCESS && two_sided != 0;
  aiString mode;
  if (material.Get("$mat.gltf.alphaMode", 0, 0, mode) == AI_SUCCESS && std::string(mode.C_Str()) != "OPAQUE") {
    part.alpha = AlphaMode::cutout;
  }
  aiString name;
  if (material.GetTexture(aiTextureType_BASE_COLOR, 0, &name) != AI_SUCCESS &&
      material.GetTexture(aiTextureType_DIFFUSE, 0, &name) != AI_SUCCESS) {
    return;
  }
  if (const auto found = known.find(name.C_Str()); found != known.end()) {
    part.texture = found->second;
    return;
  }
  auto texture = texture_named(scene, name, folder);
  part.texture = texture ? static_cast<int>(figure.textures.size()) : -1;
  if (texture) figure.textures.push_back(std::move(*texture));
  known[name.C_Str()] = part.texture;
}

void add_joints(const std::vector<Node>& nodes, Figure& figure) {
  const Eigen::Matrix3f R = y_up_to_H();
  for (const Node& node : nodes) {
    Joint joint;
    joint.name = hanim_name(node.node->mName.C_Str());
    joint.parent = node.parent;
    const Eigen::Quaternionf q(Eigen::AngleAxisf(node.global.rotation()));
    joint.X_HJ.linear() = R * q.normalized().toRotationMatrix() * R;
    joint.X_HJ.translation() = H_from_y_up(node.global.translation());
    figure.joints.push_back(std::move(joint));
  }
}

// Metres, on the floor, and the bind pose of every joint in its parent.
Result<void> settle(Figure& figure, const fs::path& path) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e9F);
  Eigen::Vector3f high = -low;
  for (const FigurePart& part : figure.parts) {
    for (const Eigen::Vector3f& p : part.positions_m) {
      if (!p.allFinite()) return bad(path, "a vertex is not a number");
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  const float tall = high.z() - low.z();
  if (!(tall > 1e-4F)) return bad(path, "it has no height");
  const float scale = tall > 50 && tall < 350 ? 0.01F : (tall < 0.6F || tall > 2.6F) ? 1.75F / tall : 1.F;
  // The root stands over the origin: a figure may have been modelled anywhere.
  const Eigen::Vector3f shift(0, 0, -low.z() * scale);
  for (FigurePart& part : figure.parts) {
    for (Eigen::Vector3f& p : part.positions_m) p = p * scale + shift;
    for (Morph& morph : part.morphs) {
      for (Eigen::Vector3f& p : morph.offsets_m) p *= scale;
    }
  }
  for (Joint& joint : figure.joints) {
    joint.X_HJ.translation() = joint.X_HJ.translation() * scale + shift;
    if (!joint.X_HJ.matrix().allFinite()) return bad(path, "joint " + joint.name + " has no place");
  }
  for (Joint& joint : figure.joints) {
    joint.X_PJ = joint.parent < 0 ? joint.X_HJ
                                  : figure.joints[static_cast<std::size_t>(joint.parent)].X_HJ.inverse() * joint.X_HJ;
  }
  return {};
}

}  // namespace

Result<Figure> load_figure(const fs::path& path) {
  if (auto fine = check_file(path); !fine) return tl::make_unexpected(fine.error());
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  const aiScene* scene =
      importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_GenSmoothNormals | aiProcess_LimitBoneWeights);
  if (scene == nullptr) return bad(path, importer.GetErrorString());
  if ((scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0 && scene->mNumMeshes == 0) return bad(path, "it holds no mesh");

  const std::vector<Node> nodes = skeleton_nodes(*scene);
  if (nodes.empty()) return bad(path, "it has no skeleton; export it with its armature and skin weights");
  if (nodes.size() > most_joints) return bad(path, "its skeleton has more than 1024 joints");
  std::unordered_map<std::string, std::uint16_t> index;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    index.emplace(nodes[i].node->mName.C_Str(), static_cast<std::uint16_t>(i));

  Figure figure;
  figure.name = path.stem().string();
  add_joints(nodes, figure);
  std::unordered_map<std::string, int> textures;
  std::size_t vertices = 0;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    if (mesh.mNumBones == 0 || mesh.mNumFaces == 0) continue;
    vertices += mesh.mNumVertices;
    if (vertices > most_vertices) return bad(path, "it has more than four million vertices");
    figure.parts.push_back(part_of(mesh, nodes, index));
    set_material(*scene, mesh, path.parent_path(), textures, figure, figure.parts.back());
  }
  if (figure.parts.empty()) return bad(path, "no mesh of it hangs on the skeleton");
  if (auto fine = settle(figure, path); !fine) return tl::make_unexpected(fine.error());
  return figure;
}

}  // namespace counterpart
