#include "vhd_renderer/body/glb_writer.hpp"

#include <cstring>
#include <fstream>
#include <system_error>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "vhd_renderer/body/axes.hpp"

namespace counterpart {
namespace {

using nlohmann::json;

constexpr int component_u16 = 5123;
constexpr int component_u32 = 5125;
constexpr int component_f32 = 5126;
constexpr int target_vertices = 34962;
constexpr int target_indices = 34963;

// Collects the binary chunk and the tables that describe it.
struct Buffer {
  std::vector<std::uint8_t> bytes;
  json views = json::array();
  json accessors = json::array();

  int view(const void* data, std::size_t size, int target) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    json entry{{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}};
    if (target != 0) entry["target"] = target;
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), first, first + size);
    views.push_back(std::move(entry));
    return static_cast<int>(views.size()) - 1;
  }

  int accessor(int view_index, int component, const char* type, std::size_t count) {
    accessors.push_back({{"bufferView", view_index}, {"componentType", component}, {"type", type}, {"count", count}});
    return static_cast<int>(accessors.size()) - 1;
  }
};

int add_points(Buffer& buffer, const std::vector<Eigen::Vector3f>& points_H, bool with_bounds) {
  std::vector<Eigen::Vector3f> points(points_H.size());
  Eigen::Vector3f low = Eigen::Vector3f::Constant(0);
  Eigen::Vector3f high = low;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = y_up_from_H(points_H[i]);
    low = i == 0 ? points[i] : low.cwiseMin(points[i]).eval();
    high = i == 0 ? points[i] : high.cwiseMax(points[i]).eval();
  }
  const int view = buffer.view(points.data(), points.size() * sizeof(Eigen::Vector3f), target_vertices);
  const int index = buffer.accessor(view, component_f32, "VEC3", points.size());
  if (with_bounds) {
    buffer.accessors.back()["min"] = {low.x(), low.y(), low.z()};
    buffer.accessors.back()["max"] = {high.x(), high.y(), high.z()};
  }
  return index;
}

template <class T>
int add_array(Buffer& buffer, const std::vector<T>& values, int component, const char* type, int target) {
  const int view = buffer.view(values.data(), values.size() * sizeof(T), target);
  return buffer.accessor(view, component, type, values.size());
}

json mesh_of(Buffer& buffer, const FigurePart& part, int material) {
  json attributes{{"POSITION", add_points(buffer, part.positions_m, true)},
                  {"NORMAL", add_points(buffer, part.normals, false)},
                  {"TEXCOORD_0", add_array(buffer, part.uvs, component_f32, "VEC2", target_vertices)},
                  {"JOINTS_0", add_array(buffer, part.joints, component_u16, "VEC4", target_vertices)},
                  {"WEIGHTS_0", add_array(buffer, part.weights, component_f32, "VEC4", target_vertices)}};
  const int view = buffer.view(part.triangles.data(), part.triangles.size() * sizeof(std::uint32_t), target_indices);
  json primitive{{"attributes", std::move(attributes)},
                 {"indices", buffer.accessor(view, component_u32, "SCALAR", part.triangles.size())},
                 {"material", material}};
  json mesh{{"name", part.name}};
  if (!part.morphs.empty()) {
    json targets = json::array();
    json names = json::array();
    for (const Morph& morph : part.morphs) {
      std::vector<Eigen::Vector3f> offsets(part.positions_m.size(), Eigen::Vector3f::Zero());
      for (std::size_t i = 0; i < morph.vertices.size(); ++i) offsets[morph.vertices[i]] = morph.offsets_m[i];
      targets.push_back({{"POSITION", add_points(buffer, offsets, true)}});
      names.push_back(morph.name);
    }
    primitive["targets"] = std::move(targets);
    mesh["weights"] = std::vector<float>(part.morphs.size(), 0.F);
    mesh["extras"] = {{"targetNames", std::move(names)}};
  }
  mesh["primitives"] = json::array({std::move(primitive)});
  return mesh;
}

json material_of(const FigurePart& part) {
  json pbr{{"metallicFactor", 0},
           {"roughnessFactor", 0.6},
           {"baseColorFactor", {part.colour.x(), part.colour.y(), part.colour.z(), 1.0}}};
  if (part.texture >= 0) pbr["baseColorTexture"] = {{"index", part.texture}};
  json material{{"name", part.name}, {"pbrMetallicRoughness", std::move(pbr)}, {"doubleSided", part.double_sided}};
  if (part.alpha == AlphaMode::cutout) {
    material["alphaMode"] = "MASK";
    material["alphaCutoff"] = 0.4;
  }
  return material;
}

Result<std::vector<std::uint8_t>> png_of(const Texture& texture) {
  const cv::Mat rgba(texture.height, texture.width, CV_8UC4, const_cast<std::uint8_t*>(texture.rgba.data()));
  cv::Mat bgra;
  cv::cvtColor(rgba, bgra, cv::COLOR_RGBA2BGRA);
  std::vector<std::uint8_t> png;
  if (!cv::imencode(".png", bgra, png, {cv::IMWRITE_PNG_COMPRESSION, 1})) {
    return failure(ErrorCode::internal, "a texture of the figure could not be encoded as PNG");
  }
  return png;
}

json node_of(const Figure& figure, int index, const std::vector<std::vector<int>>& children) {
  const Joint& joint = figure.joints[static_cast<std::size_t>(index)];
  const Eigen::Matrix3f R = y_up_to_H();
  const Eigen::Vector3f t = y_up_from_H(joint.X_PJ.translation());
  const Eigen::Quaternionf q(R * joint.X_PJ.linear() * R);
  json node{{"name", joint.name}, {"translation", {t.x(), t.y(), t.z()}}, {"rotation", {q.x(), q.y(), q.z(), q.w()}}};
  if (const auto& own = children[static_cast<std::size_t>(index)]; !own.empty()) node["children"] = own;
  return node;
}

json skin_of(Buffer& buffer, const Figure& figure) {
  const Eigen::Matrix3f R = y_up_to_H();
  std::vector<Eigen::Matrix4f> inverse_bind;
  std::vector<int> joints;
  for (std::size_t i = 0; i < figure.joints.size(); ++i) {
    Eigen::Isometry3f X = figure.joints[i].X_HJ;
    X.linear() = (R * X.linear() * R).eval();
    X.translation() = y_up_from_H(X.translation());
    inverse_bind.push_back(X.inverse().matrix());
    joints.push_back(static_cast<int>(i));
  }
  return {{"joints", std::move(joints)},
          {"skeleton", 0},
          {"inverseBindMatrices", add_array(buffer, inverse_bind, component_f32, "MAT4", 0)}};
}

void put_u32(std::ostream& out, std::uint32_t value) {
  const char bytes[4] = {static_cast<char>(value), static_cast<char>(value >> 8), static_cast<char>(value >> 16),
                         static_cast<char>(value >> 24)};
  out.write(bytes, 4);
}

Result<void> save(const std::string& text, const std::vector<std::uint8_t>& bytes, const std::filesystem::path& path) {
  const auto broken = [&](const std::string& why) {
    return failure(ErrorCode::io, "cannot write the character " + path.string() + ": " + why);
  };
  std::filesystem::path part = path;
  part += ".part";
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  if (error) return broken(error.message());
  {
    std::ofstream out(part, std::ios::binary);
    const auto size = static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bytes.size());
    put_u32(out, 0x46546C67);  // "glTF"
    put_u32(out, 2);
    put_u32(out, size);
    put_u32(out, static_cast<std::uint32_t>(text.size()));
    put_u32(out, 0x4E4F534A);  // "JSON"
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    put_u32(out, static_cast<std::uint32_t>(bytes.size()));
    put_u32(out, 0x004E4942);  // "BIN"
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!out.flush()) return broken("the disk refused the bytes");
  }
  std::filesystem::rename(part, path, error);
  if (error) return broken(error.message());
  return {};
}

}  // namespace

Result<void> write_glb(const Figure& figure, const std::filesystem::path& path) {
  Buffer buffer;
  json images = json::array();
  json textures = json::array();
  for (const Texture& texture : figure.textures) {
    auto png = png_of(texture);
    if (!png) return tl::make_unexpected(png.error());
    textures.push_back({{"source", images.size()}});
    images.push_back({{"bufferView", buffer.view(png->data(), png->size(), 0)}, {"mimeType", "image/png"}});
  }

  std::vector<std::vector<int>> children(figure.joints.size());
  std::vector<std::size_t> scene_nodes;
  for (std::size_t i = 0; i < figure.joints.size(); ++i) {
    const int parent = figure.joints[i].parent;
    if (parent < 0) {
      scene_nodes.push_back(i);
    } else {
      children[static_cast<std::size_t>(parent)].push_back(static_cast<int>(i));
    }
  }
  json nodes = json::array();
  for (std::size_t i = 0; i < figure.joints.size(); ++i) {
    nodes.push_back(node_of(figure, static_cast<int>(i), children));
  }
  json meshes = json::array();
  json materials = json::array();
  for (const FigurePart& part : figure.parts) {
    scene_nodes.push_back(nodes.size());
    // A joint and a mesh may share a name (tongue); importers that look nodes up by name need them apart.
    nodes.push_back({{"name", part.name + "_mesh"}, {"mesh", meshes.size()}, {"skin", 0}});
    meshes.push_back(mesh_of(buffer, part, static_cast<int>(materials.size())));
    materials.push_back(material_of(part));
  }

  json gltf{{"asset", {{"version", "2.0"}, {"generator", "counterpart"}}},
            {"scene", 0},
            {"scenes", json::array({{{"name", figure.name}, {"nodes", scene_nodes}}})},
            {"nodes", std::move(nodes)},
            {"meshes", std::move(meshes)},
            {"materials", std::move(materials)},
            {"skins", json::array({skin_of(buffer, figure)})}};
  if (!images.empty()) {
    gltf["images"] = std::move(images);
    gltf["textures"] = std::move(textures);
  }
  buffer.bytes.resize((buffer.bytes.size() + 3) / 4 * 4);
  gltf["bufferViews"] = std::move(buffer.views);
  gltf["accessors"] = std::move(buffer.accessors);
  gltf["buffers"] = json::array({{{"byteLength", buffer.bytes.size()}}});
  std::string text = gltf.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return save(text, buffer.bytes, path);
}

}  // namespace counterpart
