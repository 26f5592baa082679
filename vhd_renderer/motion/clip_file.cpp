#include "vhd_renderer/motion/clip_file.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <unordered_map>

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>

#include "vhd_renderer/body/joint_names.hpp"
#include "vhd_renderer/motion/curves.hpp"
#include "vhd_renderer/motion/joint_angles.hpp"
#include "vhd_renderer/motion/swivel.hpp"

namespace counterpart {
namespace {

namespace fs = std::filesystem;
using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr std::uintmax_t largest_file = 64U << 20U;
constexpr std::size_t most_nodes = 1024;
constexpr int deepest = 200;
constexpr unsigned most_keys = 200'000;  // of a joint
constexpr double longest_s = 600;
constexpr float sample_s = 0.04F;
constexpr float fade_s = 0.4F;  // at either end, so that it begins and ends where the body is
constexpr std::size_t most_files = 256;

tl::unexpected<Error> bad(const fs::path& path, const std::string& why) {
  return failure(ErrorCode::bad_format, "the clip " + path.string() + " cannot be used: " + why);
}

// A file that names other files gets those that lie beside it, and no others.
class BesideOnly : public Assimp::DefaultIOSystem {
 public:
  explicit BesideOnly(fs::path folder) : folder_(std::move(folder)) {}

  bool Exists(const char* file) const override { return DefaultIOSystem::Exists(beside(file).c_str()); }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (std::string_view(mode).find('w') != std::string_view::npos) return nullptr;
    std::error_code error;
    const fs::path path = beside(file);
    if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > largest_file) return nullptr;
    return DefaultIOSystem::Open(path.c_str(), mode);
  }

 private:
  fs::path beside(const char* file) const { return folder_ / fs::path(file).filename(); }

  fs::path folder_;
};

// The readers of all other formats, which would be tried by the looks of a file, never see it.
void keep_clip_readers(Assimp::Importer& importer) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const std::string kinds = importer.GetImporterInfo(i)->mFileExtensions;
    if (kinds == "bvh" || kinds == "gltf glb") continue;
    Assimp::BaseImporter* const reader = importer.GetImporter(i);
    if (importer.UnregisterLoader(reader) == AI_SUCCESS) delete reader;  // ours from here on
  }
}

Vector3f vector(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}
Quaternionf rotation(const aiQuaternion& q) {
  return {q.w, q.x, q.y, q.z};
}

struct Bone {
  std::string name;  // H-Anim, where it has one
  int parent = -1;
  Vector3f rest_p{0, 0, 0};  // in the parent
  Quaternionf rest_q = Quaternionf::Identity();
  const aiNodeAnim* keys = nullptr;  // null: it stays as it is at rest
};

// A file's skeleton at one moment, in the file's own axes.
struct Moment {
  std::vector<Vector3f> p;
  std::vector<Quaternionf> q;
};

template <class Key>
std::pair<unsigned, float> key_at(const Key* keys, unsigned count, double tick) {
  const Key* next = std::upper_bound(keys, keys + count, tick, [](double t, const Key& key) { return t < key.mTime; });
  if (next == keys) return {0, 0.F};
  const auto i = static_cast<unsigned>(next - keys - 1);
  if (next == keys + count) return {i, 0.F};
  return {i, static_cast<float>((tick - keys[i].mTime) / std::max(1e-9, next->mTime - keys[i].mTime))};
}

Vector3f place_at(const Bone& bone, double tick) {
  const aiNodeAnim* keys = bone.keys;
  if (keys == nullptr || keys->mNumPositionKeys == 0) return bone.rest_p;
  const auto [i, share] = key_at(keys->mPositionKeys, keys->mNumPositionKeys, tick);
  const Vector3f a = vector(keys->mPositionKeys[i].mValue);
  return share > 0 ? Vector3f(a + (vector(keys->mPositionKeys[i + 1].mValue) - a) * share) : a;
}

Quaternionf rotation_at(const Bone& bone, double tick) {
  const aiNodeAnim* keys = bone.keys;
  if (keys == nullptr || keys->mNumRotationKeys == 0) return bone.rest_q;
  const auto [i, share] = key_at(keys->mRotationKeys, keys->mNumRotationKeys, tick);
  const Quaternionf a = rotation(keys->mRotationKeys[i].mValue);
  return (share > 0 ? a.slerp(share, rotation(keys->mRotationKeys[i + 1].mValue)) : a).normalized();
}

class Skeleton {
 public:
  // Empty if there are too many nodes, or one that is no number.
  static std::optional<Skeleton> of(const aiScene& scene, const aiAnimation& animation) {
    Skeleton skeleton;
    std::unordered_map<std::string, const aiNodeAnim*> tracks;
    for (unsigned c = 0; c < animation.mNumChannels; ++c) {
      const aiNodeAnim& keys = *animation.mChannels[c];
      if (keys.mNumPositionKeys > most_keys || keys.mNumRotationKeys > most_keys) return std::nullopt;
      tracks.emplace(keys.mNodeName.C_Str(), &keys);
    }
    if (!skeleton.add(*scene.mRootNode, -1, tracks, 0)) return std::nullopt;
    return skeleton;
  }

  int find(const std::string& name) const {
    const auto found = std::find_if(bones_.begin(), bones_.end(), [&](const Bone& bone) { return bone.name == name; });
    return found == bones_.end() ? -1 : static_cast<int>(found - bones_.begin());
  }
  int find(std::size_t side, const char* name) const {
    return find(std::string(side == left_side ? "l_" : "r_") + name);
  }
  int parent(int bone) const { return bones_[at(bone)].parent; }
  bool is_above(int upper, int lower) const {
    for (; lower >= 0; lower = parent(lower)) {
      if (lower == upper) return true;
    }
    return false;
  }

  Moment rest() const {
    return moment([](const Bone& bone) { return std::pair(bone.rest_p, bone.rest_q); });
  }
  Moment at_tick(double tick) const {
    return moment([&](const Bone& bone) { return std::pair(place_at(bone, tick), rotation_at(bone, tick)); });
  }

 private:
  bool add(const aiNode& node, int parent, const std::unordered_map<std::string, const aiNodeAnim*>& tracks,
           int depth) {
    if (depth > deepest || bones_.size() >= most_nodes) return false;
    Bone bone;
    bone.name = hanim_name(node.mName.C_Str());
    bone.parent = parent;
    aiVector3D scale, place;
    aiQuaternion turn;
    node.mTransformation.Decompose(scale, turn, place);
    bone.rest_p = vector(place);
    bone.rest_q = rotation(turn).normalized();
    if (!bone.rest_p.allFinite() || !bone.rest_q.coeffs().allFinite()) return false;
    if (const auto found = tracks.find(node.mName.C_Str()); found != tracks.end()) bone.keys = found->second;
    const int own = static_cast<int>(bones_.size());
    bones_.push_back(std::move(bone));
    for (unsigned c = 0; c < node.mNumChildren; ++c) {
      if (!add(*node.mChildren[c], own, tracks, depth + 1)) return false;
    }
    return true;
  }

  template <class Local>
  Moment moment(Local local) const {
    Moment m;
    for (const Bone& bone : bones_) {
      const auto [p, q] = local(bone);
      const bool root = bone.parent < 0;
      m.p.push_back(root ? p : Vector3f(m.p[at(bone.parent)] + m.q[at(bone.parent)] * p));
      m.q.push_back(root ? q : (m.q[at(bone.parent)] * q).normalized());
    }
    return m;
  }

  std::vector<Bone> bones_;  // parents first
};

// Where the parts that a clip speaks of are in a file's skeleton; -1: it has none.
struct Parts {
  int root = -1;
  int chest = -1;  // carries neck and arms
  int head = -1;
  struct Arm {
    int shoulder = -1, elbow = -1, wrist = -1, index = -1, middle = -1, pinky = -1;
    bool whole() const { return shoulder >= 0 && elbow >= 0 && wrist >= 0; }
  };
  std::array<Arm, 2> arms;
  Quaternionf R_HF;  // the file's axes to H (x right, y forward, z up)
};

// The file's axes from how the body stands at rest; empty if it lies or has no sides.
std::optional<Quaternionf> axes_of(const Skeleton& skeleton, const Parts& parts, const Moment& rest) {
  const auto across = [&](const char* name) {
    const int left = skeleton.find(left_side, name);
    const int right = skeleton.find(right_side, name);
    return left < 0 || right < 0 ? Vector3f(0, 0, 0) : Vector3f(rest.p[at(right)] - rest.p[at(left)]);
  };
  Vector3f right = across("shoulder");
  if (right.norm() < 1e-6F) right = across("hip");
  const Vector3f up = rest.p[at(parts.head)] - rest.p[at(parts.root)];
  const Vector3f forward = up.cross(right);
  if (!(forward.norm() > 1e-9F)) return std::nullopt;
  Eigen::Matrix3f R_FH;
  // Which way is up is one of the file's axes: a body that stands bent at rest is not turned upright by it.
  int axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  const Vector3f z = Vector3f::Unit(axis) * (up[axis] < 0 ? -1.F : 1.F);
  const Vector3f y = (forward - z * z.dot(forward)).normalized();
  R_FH << y.cross(z), y, z;
  if (!R_FH.allFinite()) return std::nullopt;
  return Quaternionf(R_FH).conjugate();
}

Result<Parts> parts_of(const Skeleton& skeleton, const Moment& rest, const fs::path& path) {
  Parts parts;
  parts.root = skeleton.find("HumanoidRoot");
  parts.head = skeleton.find("skullbase");
  for (const std::size_t s : {left_side, right_side}) {
    parts.arms[s] = {skeleton.find(s, "shoulder"), skeleton.find(s, "elbow"),   skeleton.find(s, "wrist"),
                     skeleton.find(s, "index1"),   skeleton.find(s, "middle1"), skeleton.find(s, "pinky1")};
  }
  if (parts.root < 0 || parts.head < 0 || !skeleton.is_above(parts.root, parts.head)) {
    return bad(path, "it has no hips and head; name its joints as H-Anim, Mixamo or VRM do (Hips, Spine, Head ...)");
  }
  // The lowest joint that head and arms hang on.
  parts.chest = skeleton.parent(parts.head);
  if (const int neck = skeleton.find("vc7"); neck >= 0 && skeleton.is_above(neck, parts.head)) {
    parts.chest = skeleton.parent(neck);
  }
  for (const Parts::Arm& arm : parts.arms) {
    while (arm.whole() && parts.chest >= 0 && !skeleton.is_above(parts.chest, arm.shoulder)) {
      parts.chest = skeleton.parent(parts.chest);
    }
  }
  if (parts.chest < 0 || !skeleton.is_above(parts.root, parts.chest))
    return bad(path, "its arms do not hang on its trunk");
  const auto axes = axes_of(skeleton, parts, rest);
  if (!axes) return bad(path, "at rest it does not stand upright with its left and right side apart");
  parts.R_HF = *axes;
  return parts;
}

// A file's moments in the terms of a clip.
class Reader {
 public:
  Reader(const Skeleton& skeleton, const Parts& parts, const Moment& rest)
      : skeleton_(skeleton), parts_(parts), rest_(rest) {
    for (const std::size_t s : {left_side, right_side}) {
      const Parts::Arm& arm = parts.arms[s];
      if (!arm.whole()) continue;
      arm_length_[s] = (place(rest, arm.elbow) - place(rest, arm.shoulder)).norm() +
                       (place(rest, arm.wrist) - place(rest, arm.elbow)).norm();
      hand_at_rest_[s] = hand_frame(s);
    }
  }

  bool has_hands() const { return arm_length_[left_side] > 1e-6F && arm_length_[right_side] > 1e-6F; }

  void add(float t_s, float weight, const Moment& m, Clip& clip) const {
    const Quaternionf pelvis = turn(m, parts_.root);
    const Quaternionf chest = turn(m, parts_.chest);
    const Vector3f ahead = pelvis * Vector3f::UnitY();
    const Quaternionf heading(Eigen::AngleAxisf(std::atan2(-ahead.x(), ahead.y()), Vector3f::UnitZ()));
    clip.pelvis.emplace_back(t_s, turn_of(heading.conjugate() * pelvis) * weight);
    clip.spine.emplace_back(t_s, turn_of(pelvis.conjugate() * chest) * weight);
    clip.head.emplace_back(t_s, turn_of(chest.conjugate() * turn(m, parts_.head)) * weight);
    if (!has_hands()) return;
    const Vector3f origin = 0.5F * (place(m, parts_.arms[0].shoulder) + place(m, parts_.arms[1].shoulder));
    for (const std::size_t s : {left_side, right_side}) add_arm(t_s, s, m, heading, origin, clip);
  }

 private:
  Vector3f place(const Moment& m, int bone) const { return parts_.R_HF * m.p[at(bone)]; }

  // How a bone is turned from rest, in H.
  Quaternionf turn(const Moment& m, int bone) const {
    return (parts_.R_HF * m.q[at(bone)] * rest_.q[at(bone)].conjugate() * parts_.R_HF.conjugate()).normalized();
  }

  // The hand frame W at rest, in H.
  Quaternionf hand_frame(std::size_t s) const {
    const Parts::Arm& arm = parts_.arms[s];
    const Vector3f wrist = place(rest_, arm.wrist);
    const Vector3f fore = (wrist - place(rest_, arm.elbow)).normalized();
    const Vector3f x = arm.middle >= 0 ? Vector3f((place(rest_, arm.middle) - wrist).normalized()) : fore;
    Vector3f z;
    if (arm.index >= 0 && arm.pinky >= 0) {
      const Vector3f radial = place(rest_, arm.index) - place(rest_, arm.pinky);
      z = s == right_side ? x.cross(radial) : radial.cross(x);
    } else {
      // Without fingers: arms that are spread have their palms down, arms that hang have them against the body.
      const Vector3f outward(s == right_side ? 1.F : -1.F, 0, 0);
      z = Vector3f::UnitZ() * std::abs(x.x()) + outward * std::abs(x.z());
    }
    z -= x * x.dot(z);
    if (z.norm() < 1e-6F) z = x.unitOrthogonal();
    z.normalize();
    Eigen::Matrix3f R;
    R << x, z.cross(x), z;
    return Quaternionf(R);
  }

  void add_arm(float t_s, std::size_t s, const Moment& m, const Quaternionf& heading, const Vector3f& origin,
               Clip& clip) const {
    const Parts::Arm& arm = parts_.arms[s];
    const auto here = [&](int bone) {
      return Vector3f(heading.conjugate() * (place(m, bone) - origin) / arm_length_[s]);
    };
    HandKey key;
    key.place = here(arm.wrist);
    key.rotation = (heading.conjugate() * turn(m, arm.wrist) * hand_at_rest_[s]).normalized();
    clip.hand[s].emplace_back(t_s, key);
    const Vector3f shoulder = here(arm.shoulder);
    const Swivel swivel = Swivel::of_arm(Quaternionf::Identity(), shoulder, key.place, s == right_side ? 1.F : -1.F);
    const Vector3f elbow = here(arm.elbow) - shoulder;
    const bool straight = elbow.cross(swivel.line).norm() < 0.04F;
    const float lift =
        straight ? (clip.swivel[s].empty() ? 0.F : clip.swivel[s].back().second) : swivel.angle_of(elbow);
    clip.swivel[s].emplace_back(t_s, std::clamp(lift, radians(-60), radians(110)));
    if (arm.middle >= 0) clip.shape[s].emplace_back(t_s, shape(s, m, key.rotation, heading));
  }

  // Fingers as far as the file has them: the bend of their first two joints; the third goes with the second.
  HandShape shape(std::size_t s, const Moment& m, const Quaternionf& hand, const Quaternionf& heading) const {
    static constexpr std::array<const char*, 5> names{"", "index", "middle", "ring", "pinky"};
    HandShape shape = hand_shape("relaxed");
    const Vector3f x = heading * (hand * Vector3f::UnitX());
    const Vector3f z = heading * (hand * Vector3f::UnitZ());
    for (std::size_t f = 1; f < names.size(); ++f) {
      std::array<int, 3> joint{};
      for (std::size_t k = 0; k < 3; ++k) {
        joint[k] = skeleton_.find(s, (std::string(names[f]) + std::to_string(k + 1)).c_str());
      }
      if (joint[0] < 0 || joint[1] < 0) continue;
      const Vector3f first = (place(m, joint[1]) - place(m, joint[0])).normalized();
      const Vector3f axis = z.cross(first).normalized();
      const auto bend = [&](const Vector3f& from, const Vector3f& to) {
        return std::atan2(from.cross(to).dot(axis), from.dot(to));
      };
      FingerBend& finger = shape.fingers[f];
      finger.flex_rad[0] = std::clamp(bend(x, first), radians(-15), radians(90));
      if (joint[2] < 0) continue;
      const Vector3f second = (place(m, joint[2]) - place(m, joint[1])).normalized();
      finger.flex_rad[1] = std::clamp(bend(first, second), 0.F, radians(105));
      finger.flex_rad[2] = 0.67F * finger.flex_rad[1];
    }
    return shape;
  }

  const Skeleton& skeleton_;
  const Parts& parts_;
  const Moment& rest_;
  std::array<float, 2> arm_length_{};
  std::array<Quaternionf, 2> hand_at_rest_;
};

// No part turns or moves faster than a person does, and none farther than a person's goes.
void hold_back(Clip& clip) {
  constexpr float fastest_rad_s = 5, fastest_arms_s = 6, farthest = 1.25F;
  const auto slow = [](Keys<Turn>& keys, const Turn& most) {
    Turn before;
    float before_s = 0;
    for (auto& [time_s, turn] : keys) {
      const float step = keys.front().first == time_s ? pi_f : fastest_rad_s * (time_s - before_s);
      const auto held = [&](float to, float from, float limit) {
        return std::clamp(std::clamp(to, -limit, limit), from - step, from + step);
      };
      turn = {held(turn.pitch, before.pitch, most.pitch), held(turn.roll, before.roll, most.roll),
              held(turn.yaw, before.yaw, most.yaw)};
      before = turn;
      before_s = time_s;
    }
  };
  slow(clip.pelvis, {radians(20), radians(12), radians(15)});
  slow(clip.spine, {radians(30), radians(22), radians(30)});
  slow(clip.head, {radians(32), radians(25), radians(50)});
  for (auto& keys : clip.hand) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      HandKey& key = keys[i].second;
      if (key.place.norm() > farthest) key.place *= farthest / key.place.norm();
      if (i == 0) continue;
      const HandKey& before = keys[i - 1].second;
      const float step_s = keys[i].first - keys[i - 1].first;
      const Vector3f way = key.place - before.place;
      if (way.norm() > fastest_arms_s * step_s) key.place = before.place + way.normalized() * (fastest_arms_s * step_s);
      const float angle = before.rotation.angularDistance(key.rotation);
      const float most = 2 * fastest_rad_s * step_s;
      if (angle > most) key.rotation = before.rotation.slerp(most / angle, key.rotation);
    }
  }
}

bool finite(const Clip& clip) {
  const auto turns = [](const Keys<Turn>& keys) {
    return std::all_of(keys.begin(), keys.end(), [](const auto& key) {
      return std::isfinite(key.second.pitch) && std::isfinite(key.second.roll) && std::isfinite(key.second.yaw);
    });
  };
  const auto hands = [](const Keys<HandKey>& keys) {
    return std::all_of(keys.begin(), keys.end(), [](const auto& key) {
      return key.second.place.allFinite() && key.second.rotation.coeffs().allFinite();
    });
  };
  const auto angles = [](const Keys<float>& keys) {
    return std::all_of(keys.begin(), keys.end(), [](const auto& key) { return std::isfinite(key.second); });
  };
  return turns(clip.pelvis) && turns(clip.spine) && turns(clip.head) && hands(clip.hand[0]) && hands(clip.hand[1]) &&
         angles(clip.swivel[0]) && angles(clip.swivel[1]);
}

Result<Clip> clip_of(const aiScene& scene, const fs::path& path) {
  if (scene.mNumAnimations == 0) return bad(path, "it holds no animation");
  const aiAnimation& animation = *scene.mAnimations[0];
  const double rate = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 25;
  const double seconds = animation.mDuration / rate;
  if (!(seconds > 0.1 && seconds <= longest_s)) return bad(path, "it lasts less than 0.1 s or more than ten minutes");
  const auto skeleton = Skeleton::of(scene, animation);
  if (!skeleton) return bad(path, "it has too many joints or keys, or a place that is no number");
  const Moment rest = skeleton->rest();
  const auto parts = parts_of(*skeleton, rest, path);
  if (!parts) return tl::make_unexpected(parts.error());
  const Reader reader(*skeleton, *parts, rest);
  Clip clip;
  clip.seconds = static_cast<float>(seconds);
  clip.sampled = true;
  const int samples = std::max(2, static_cast<int>(std::lround(clip.seconds / sample_s)));
  const float fade = std::min(fade_s, clip.seconds / 2);
  for (int i = 0; i <= samples; ++i) {
    const float t = clip.seconds * static_cast<float>(i) / static_cast<float>(samples);
    const float weight = minimum_jerk(t / fade) * minimum_jerk((clip.seconds - t) / fade);
    reader.add(t, weight, skeleton->at_tick(static_cast<double>(t) * rate), clip);
  }
  if (!finite(clip)) return bad(path, "a joint's place or turn in it is no number");
  hold_back(clip);
  return clip;
}

Result<std::string> bytes_of(const fs::path& path) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return failure(ErrorCode::not_found, "there is no clip " + path.string());
  if (size > largest_file) return failure(ErrorCode::limit_exceeded, "the clip " + path.string() + " is over 64 MB");
  std::ifstream in(path, std::ios::binary);
  std::stringstream bytes;
  bytes << in.rdbuf();
  if (!in) return failure(ErrorCode::io, "cannot read the clip " + path.string());
  return bytes.str();
}

// assimp reads beyond a cut GLB's end without a word in some places, so its own header is asked first.
bool is_whole_glb(const std::string& bytes) {
  if (bytes.size() < 12 || bytes.compare(0, 4, "glTF") != 0) return false;
  std::uint32_t announced = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    announced |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[8 + k])) << (8 * k);
  }
  return announced <= bytes.size();
}

bool is_plain_name(const std::string& name) {
  return !name.empty() && name.size() <= 40 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

bool is_clip_file(const fs::path& path) {
  const fs::path kind = path.extension();
  return kind == ".bvh" || kind == ".gltf" || kind == ".glb" || kind == ".json";
}

}  // namespace

Result<Clip> read_clip_file(const fs::path& path) {
  if (!is_clip_file(path)) return bad(path, "only .bvh, .gltf, .glb and .json files are clips");
  const auto bytes = bytes_of(path);
  if (!bytes) return tl::make_unexpected(bytes.error());
  Result<Clip> clip = tl::make_unexpected(Error{});
  if (path.extension() == ".json") {
    clip = parse_clip(*bytes);
    if (!clip) return bad(path, clip.error().message);
  } else {
    if (path.extension() == ".glb" && !is_whole_glb(*bytes)) return bad(path, "it is no GLB file, or cut off");
    Assimp::Importer importer;
    keep_clip_readers(importer);
    importer.SetIOHandler(new BesideOnly(path.parent_path()));  // the importer's from here on
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    const aiScene* scene = importer.ReadFile(path.string(), 0);
    if (scene == nullptr || scene->mRootNode == nullptr) return bad(path, importer.GetErrorString());
    clip = clip_of(*scene, path);
    if (!clip) return clip;
  }
  clip->name = path.stem().string();
  return clip;
}

Result<ClipLibrary> clips_with_folder(const fs::path& folder) {
  ClipLibrary clips = clip_library();
  if (folder.empty()) return clips;
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->is_regular_file(error) && is_clip_file(entry->path())) files.push_back(entry->path());
    if (files.size() > most_files)
      return failure(ErrorCode::limit_exceeded, "more than 256 clips in " + folder.string());
  }
  if (error)
    return failure(ErrorCode::not_found, "cannot read the clips folder " + folder.string() + ": " + error.message());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const std::string name = file.stem().string();
    if (!is_plain_name(name)) return bad(file, "its name has to be 1 to 40 of a-z, 0-9, _ and -");
    if (clips.count(name) != 0)
      return bad(file, "there is a clip \"" + name + "\" already; give the file another name");
    auto clip = read_clip_file(file);
    if (!clip) return tl::make_unexpected(clip.error());
    clips.emplace(name, std::move(*clip));
  }
  return clips;
}

}  // namespace counterpart
