#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "vhd_renderer/body/axes.hpp"
#include "vhd_renderer/body/build_character.hpp"
#include "vhd_renderer/body/decode_texture.hpp"
#include "vhd_renderer/body/joint_names.hpp"
#include "vhd_renderer/body/makehuman_package.hpp"

namespace counterpart {
namespace {

namespace fs = std::filesystem;
using makehuman::Corner;
using makehuman::Mesh;
using makehuman::Proxy;
using makehuman::Targets;
using Points = std::vector<Eigen::Vector3f>;

// A named shape with its share of the whole.
struct Share {
  std::string name;
  double weight = 0;
};

std::vector<Share> shares_of(double value, const char* low, const char* middle, const char* high) {
  const double above = std::max(0.0, value * 2 - 1);
  const double below = std::max(0.0, 1 - value * 2);
  return {{low, below}, {middle, 1 - above - below}, {high, above}};
}

// MakeHuman's "macro" targets: origin x sex x age, and the build.
std::vector<Share> shape_targets(const Character& c) {
  const std::string sex = c.female ? "female" : "male";
  const double old = std::clamp((c.age_years - 25.0) / 65.0, 0.0, 1.0);
  const std::vector<Share> ages{{"young", 1 - old}, {"old", old}};
  std::vector<Share> targets;
  for (const Share& age : ages) {
    for (const auto& [origin, share] : c.origins) {
      targets.push_back({"macrodetails/" + origin + "-" + sex + "-" + age.name, share * age.weight});
    }
    for (const Share& muscle : shares_of(c.muscle, "minmuscle", "averagemuscle", "maxmuscle")) {
      for (const Share& weight : shares_of(c.weight, "minweight", "averageweight", "maxweight")) {
        const std::string build = sex + "-" + age.name + "-" + muscle.name + "-" + weight.name;
        const double share = age.weight * muscle.weight * weight.weight;
        targets.push_back({"macrodetails/universal-" + build, share});
        for (const Share& height : shares_of(c.height, "minheight", "", "maxheight")) {
          if (height.name.empty()) continue;
          targets.push_back({"macrodetails/height/" + build + "-" + height.name, share * height.weight});
        }
      }
    }
  }
  targets.erase(std::remove_if(targets.begin(), targets.end(), [](const Share& t) { return t.weight < 1e-6; }),
                targets.end());
  return targets;
}

std::string main_origin(const Character& c) {
  const auto most = std::max_element(c.origins.begin(), c.origins.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == c.origins.end() ? "caucasian" : most->first;
}

// The face shapes that expressions, blinking and speech are mixed from.
constexpr const char* face_shapes[] = {"eye-left-closure",
                                       "eye-right-closure",
                                       "eye-left-opened-up",
                                       "eye-right-opened-up",
                                       "eye-left-slit",
                                       "eye-right-slit",
                                       "eyebrows-left-down",
                                       "eyebrows-right-down",
                                       "eyebrows-left-inner-up",
                                       "eyebrows-right-inner-up",
                                       "eyebrows-left-up",
                                       "eyebrows-right-up",
                                       "mouth-compression",
                                       "mouth-corner-puller",
                                       "mouth-depression",
                                       "mouth-elevation",
                                       "mouth-open",
                                       "mouth-parling",
                                       "mouth-part-later",
                                       "mouth-protusion",
                                       "mouth-pursing",
                                       "mouth-retraction",
                                       "mouth-upward-retraction",
                                       "mouth-eversion"};

struct FaceShape {
  std::string name;
  Points offsets_dm;  // by base vertex
};

struct Body {
  Mesh base;
  Points shaped_dm;
  std::vector<FaceShape> face;
  std::vector<makehuman::Bone> rig;
  std::unordered_map<std::string, std::uint16_t> joint_of_bone;
};

Eigen::Vector3f mean(const Points& points, const std::vector<std::uint32_t>& which) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const std::uint32_t v : which) sum += points[v];
  return sum / static_cast<float>(which.size());
}

Points smooth_normals(const Points& positions, const std::vector<Corner>& corners) {
  Points normals(positions.size(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const Eigen::Vector3f& a = positions[corners[i].vertex];
    const Eigen::Vector3f n =
        (positions[corners[i + 1].vertex] - a).cross(positions[corners[i + 2].vertex] - a);  // longer for larger faces
    for (std::size_t k = 0; k < 3; ++k) normals[corners[i + k].vertex] += n;
  }
  for (Eigen::Vector3f& n : normals) {
    const float length = n.norm();
    n = length > 1e-12F ? Eigen::Vector3f(n / length) : Eigen::Vector3f::UnitY();
  }
  return normals;
}

struct Source {
  const Mesh* mesh = nullptr;
  const Points* positions_dm = nullptr;
  const std::vector<FaceShape>* face = nullptr;  // by vertex of the mesh
};

// Corners become vertices (one for each pair of position and uv), decimetres y up become metres in H.
FigurePart part_of(const std::string& name, const Source& from, const std::vector<Corner>& corners,
                   const Points& normals, const Body& body) {
  FigurePart part;
  part.name = name;
  std::unordered_map<std::uint64_t, std::uint32_t> known;
  std::vector<std::uint32_t> source;
  for (const Corner& corner : corners) {
    const std::uint64_t key = (static_cast<std::uint64_t>(corner.vertex) << 32U) | corner.uv;
    const auto [at, fresh] = known.emplace(key, static_cast<std::uint32_t>(source.size()));
    if (fresh) {
      source.push_back(corner.vertex);
      const Eigen::Vector2f& uv = from.mesh->uvs[corner.uv];
      part.uvs.emplace_back(uv.x(), 1 - uv.y());
    }
    part.triangles.push_back(at->second);
  }
  for (const std::uint32_t v : source) {
    part.positions_m.push_back(H_from_y_up((*from.positions_dm)[v]) * 0.1F);
    part.normals.push_back(H_from_y_up(normals[v]));
    std::array<std::uint16_t, 4> joints{};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto found = body.joint_of_bone.find(from.mesh->bone_names[from.mesh->bones[v][k]]);
      joints[k] = found == body.joint_of_bone.end() ? std::uint16_t{0} : found->second;
    }
    part.joints.push_back(joints);
    part.weights.push_back(from.mesh->weights[v]);
  }
  for (const FaceShape& shape : *from.face) {
    Morph morph;
    morph.name = shape.name;
    for (std::uint32_t i = 0; i < source.size(); ++i) {
      const Eigen::Vector3f offset = H_from_y_up(shape.offsets_dm[source[i]]) * 0.1F;
      if (offset.norm() < 1e-5F) continue;
      morph.vertices.push_back(i);
      morph.offsets_m.push_back(offset);
    }
    if (!morph.vertices.empty()) part.morphs.push_back(std::move(morph));
  }
  return part;
}

// The colour map among the pictures of a folder: not a normal map, not baked shadow, not the suit painted on the skin.
fs::path colour_map(const fs::path& folder) {
  std::vector<fs::path> candidates;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool other = name.find("_normal") != std::string::npos || name.find("_ao") != std::string::npos ||
                       name.find("special_suit") != std::string::npos;
    if (entry.path().extension() == ".png" && !other) candidates.push_back(entry.path());
  }
  std::sort(candidates.begin(), candidates.end());
  return candidates.empty() ? folder / "(no picture)" : candidates.front();
}

fs::path skin_map(const Character& c, const fs::path& data) {
  const std::string age = c.age_years < 42 ? "young" : c.age_years < 60 ? "middleage" : "old";
  return colour_map(data / "skins" / (age + "_" + main_origin(c) + (c.female ? "_female" : "_male")) / "textures");
}

Result<Body> read_body(const Character& c, const fs::path& package) {
  Body body;
  auto base = makehuman::read_base(package);
  if (!base) return tl::make_unexpected(base.error());
  body.base = std::move(*base);
  auto rig = makehuman::read_rig(package);
  if (!rig) return tl::make_unexpected(rig.error());
  body.rig = std::move(*rig);
  const auto targets = Targets::open(package);
  if (!targets) return tl::make_unexpected(targets.error());
  body.shaped_dm = body.base.positions_dm;
  for (const Share& share : shape_targets(c)) {
    if (!targets->has(share.name)) continue;  // the package has no target where nothing changes
    const auto offsets = targets->read(share.name);
    if (!offsets) return tl::make_unexpected(offsets.error());
    const auto weight = static_cast<float>(share.weight);
    for (std::size_t v = 0; v < offsets->size(); ++v) body.shaped_dm[v] += weight * (*offsets)[v];
  }
  for (const char* shape : face_shapes) {
    auto offsets = targets->read("expression/units/" + main_origin(c) + "/" + shape);
    if (!offsets) return tl::make_unexpected(offsets.error());
    body.face.push_back({shape, std::move(*offsets)});
  }
  for (std::size_t i = 0; i < body.rig.size(); ++i)
    body.joint_of_bone[body.rig[i].name] = static_cast<std::uint16_t>(i);
  return body;
}

void add_joint(Figure& figure, const std::string& name, int parent, const Eigen::Vector3f& p_H) {
  Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.X_HJ.translation() = p_H;
  joint.X_PJ.translation() =
      parent < 0 ? p_H : Eigen::Vector3f(p_H - figure.joints[static_cast<std::size_t>(parent)].X_HJ.translation());
  figure.joints.push_back(std::move(joint));
}

void add_skeleton(Figure& figure, const Body& body) {
  for (const makehuman::Bone& bone : body.rig) {
    add_joint(figure, hanim_name(bone.name), bone.parent, H_from_y_up(mean(body.shaped_dm, bone.head)) * 0.1F);
  }
  // The ends of the fingers are no bones of the rig, but hands are measured by them.
  for (const char* side : {"l_", "r_"}) {
    for (const char* finger : {"thumb", "index", "middle", "ring", "pinky"}) {
      for (std::size_t i = 0; i < body.rig.size(); ++i) {
        if (figure.joints[i].name != std::string(side) + finger + "3") continue;
        add_joint(figure, std::string(side) + finger + "_distal_tip", static_cast<int>(i),
                  H_from_y_up(mean(body.shaped_dm, body.rig[i].tail)) * 0.1F);
      }
    }
  }
}

struct Wear {
  std::string kind;
  std::string name;
  AlphaMode alpha = AlphaMode::opaque;
  bool double_sided = false;
};

std::vector<Wear> wardrobe(const Character& c) {
  std::vector<Wear> wear;
  for (const std::string& one : c.clothes) wear.push_back({"clothes", one, AlphaMode::opaque, false});
  if (!c.hair.empty()) wear.push_back({"hair", c.hair, AlphaMode::cutout, true});
  wear.push_back({"eyes", "HighPolyEyes", AlphaMode::cutout, false});
  if (!c.eyebrows.empty()) wear.push_back({"eyebrows", c.eyebrows, AlphaMode::cutout, true});
  wear.push_back({"eyelashes", "Eyelashes01", AlphaMode::cutout, true});
  wear.push_back({"teeth", "Teeth_Base", AlphaMode::opaque, false});
  wear.push_back({"tongue", "tongue01", AlphaMode::opaque, false});
  return wear;
}

// A thing worn follows the body: weighted sum of three vertices of the base, plus its own offset (MakeHuman's mhclo).
Points fitted(const Proxy& proxy, const Points& base, bool with_offsets) {
  Points fit(proxy.base_refs.size());
  for (std::size_t v = 0; v < fit.size(); ++v) {
    fit[v] = with_offsets ? proxy.offsets_dm[v] : Eigen::Vector3f::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      fit[v] += proxy.base_weights[v][static_cast<int>(k)] * base[proxy.base_refs[v][k]];
  }
  return fit;
}

Result<FigurePart> dress(const Wear& wear, const Proxy& proxy, const Body& body) {
  const Points positions = fitted(proxy, body.shaped_dm, true);
  std::vector<FaceShape> face;
  if (wear.kind != "clothes" && wear.kind != "hair") {
    for (const FaceShape& shape : body.face) face.push_back({shape.name, fitted(proxy, shape.offsets_dm, false)});
  }
  const Source source{&proxy.mesh, &positions, &face};
  FigurePart part = part_of(wear.name, source, proxy.mesh.corners, smooth_normals(positions, proxy.mesh.corners), body);
  part.alpha = wear.alpha;
  part.double_sided = wear.double_sided;
  return part;
}

// The body in two parts, so that only the part with a face carries face shapes.
void add_body(Figure& figure, const Body& body, const std::vector<bool>& hidden, int texture) {
  std::vector<bool> moves(makehuman::base_vertices, false);
  for (const FaceShape& shape : body.face) {
    for (std::size_t v = 0; v < moves.size(); ++v) moves[v] = moves[v] || shape.offsets_dm[v].norm() > 1e-4F;
  }
  std::vector<Corner> head;
  std::vector<Corner> rest;
  const std::vector<Corner>& all = body.base.corners;
  for (std::size_t i = 0; i + 2 < all.size(); i += 3) {
    bool seen = true;
    bool face = false;
    for (std::size_t k = 0; k < 3; ++k) {
      seen = seen && !hidden[all[i + k].vertex];
      face = face || moves[all[i + k].vertex];
    }
    if (!seen) continue;
    std::vector<Corner>& into = face ? head : rest;
    into.insert(into.end(), all.begin() + static_cast<std::ptrdiff_t>(i),
                all.begin() + static_cast<std::ptrdiff_t>(i) + 3);
  }
  const Points normals = smooth_normals(body.shaped_dm, all);
  const std::vector<FaceShape> none;
  for (const auto& [name, corners, face] : {std::tuple{"head", &head, &body.face}, std::tuple{"body", &rest, &none}}) {
    figure.parts.push_back(part_of(name, {&body.base, &body.shaped_dm, face}, *corners, normals, body));
    figure.parts.back().texture = texture;
  }
}

void stand_on_floor(Figure& figure) {
  float lowest = 0;
  for (const FigurePart& part : figure.parts) {
    for (const Eigen::Vector3f& p : part.positions_m) lowest = std::min(lowest, p.z());
  }
  for (FigurePart& part : figure.parts) {
    for (Eigen::Vector3f& p : part.positions_m) p.z() -= lowest;
  }
  for (Joint& joint : figure.joints) {
    joint.X_HJ.translation().z() -= lowest;
    if (joint.parent < 0) joint.X_PJ.translation().z() -= lowest;
  }
}

}  // namespace

Result<Figure> make_figure(const Character& character, const fs::path& package) {
  const auto body = read_body(character, package);
  if (!body) return tl::make_unexpected(body.error());
  const fs::path data = package / "public/data";
  Figure figure;
  figure.name = character.name;
  add_skeleton(figure, *body);

  std::vector<bool> hidden(makehuman::base_vertices, false);
  std::vector<FigurePart> worn;
  for (const Wear& wear : wardrobe(character)) {
    const auto proxy = makehuman::read_proxy(package, wear.kind, wear.name);
    if (!proxy) return tl::make_unexpected(proxy.error());
    for (std::size_t v = 0; v < hidden.size(); ++v)
      hidden[v] = hidden[v] || (wear.kind == "clothes" && proxy->hides[v]);
    auto part = dress(wear, *proxy, *body);
    if (!part) return tl::make_unexpected(part.error());
    const fs::path pictures = data / "proxies" / wear.kind / wear.name / "textures";
    auto texture = read_texture(wear.kind == "eyes" ? pictures / (character.eyes + "_eye.png") : colour_map(pictures));
    if (!texture) return tl::make_unexpected(texture.error());
    part->texture = static_cast<int>(figure.textures.size());
    figure.textures.push_back(std::move(*texture));
    worn.push_back(std::move(*part));
  }
  auto skin = read_texture(skin_map(character, data));
  if (!skin) return tl::make_unexpected(skin.error());
  add_body(figure, *body, hidden, static_cast<int>(figure.textures.size()));
  figure.textures.push_back(std::move(*skin));
  for (FigurePart& part : worn) figure.parts.push_back(std::move(part));
  stand_on_floor(figure);
  return figure;
}

}  // namespace counterpart
