#include "vhd_renderer/motion/clip.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <nlohmann/json.hpp>

#include "vhd_renderer/motion/command_queue.hpp"
#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;
using nlohmann::json;

Turn mix(const Turn& a, const Turn& b, float t) {
  return a * (1 - t) + b * t;
}
float mix(float a, float b, float t) {
  return lerp(a, b, t);
}
std::array<float, 2> mix(const std::array<float, 2>& a, const std::array<float, 2>& b, float t) {
  return {lerp(a[0], b[0], t), lerp(a[1], b[1], t)};
}
HandKey mix(const HandKey& a, const HandKey& b, float t) {
  return {a.place + (b.place - a.place) * t, a.rotation.slerp(t, b.rotation)};
}
HandShape mix(const HandShape& a, const HandShape& b, float t) {
  return blend(a, b, t);
}

template <class T>
T value_at(const Clip& clip, const Keys<T>& keys, float t) {
  const auto later = [](float time, const auto& key) { return time < key.first; };
  const auto next = std::upper_bound(keys.begin(), keys.end(), t, later);
  if (next == keys.begin()) return next->second;
  const auto last = std::prev(next);
  if (next == keys.end()) return last->second;
  const float share = (t - last->first) / std::max(1e-3F, next->first - last->first);
  return mix(last->second, next->second, clip.sampled ? share : minimum_jerk(share));
}

// In the plane x = 0. The hand frame W keeps x along the fingers and z out of the back on both sides.
HandKey mirrored(const HandKey& key) {
  const auto flip = [](const Vector3f& v) { return Vector3f(-v.x(), v.y(), v.z()); };
  const Vector3f x = flip(key.rotation * Vector3f::UnitX());
  const Vector3f z = flip(key.rotation * Vector3f::UnitZ());
  Eigen::Matrix3f R;
  R << x, z.cross(x), z;
  return {flip(key.place), Quaternionf(R)};
}

tl::unexpected<Error> wrong(const std::string& what) {
  return failure(ErrorCode::bad_format, "clip: " + what);
}

struct BadClip {
  std::string what;
};

// One key's numbers; throws BadClip, which parse_clip catches.
std::vector<float> numbers(const json& key, std::size_t count, const std::string& track) {
  if (!key.is_array() || key.size() != count + 1) {
    throw BadClip{"a key of \"" + track + "\" needs a time and " + std::to_string(count) + " numbers"};
  }
  std::vector<float> values;
  for (const json& one : key) {
    if (!one.is_number() || !std::isfinite(one.get<float>()))
      throw BadClip{"\"" + track + "\" holds what is no number"};
    values.push_back(one.get<float>());
  }
  return values;
}

template <class T, class Make>
Keys<T> keys_of(const json& track, std::size_t count, const std::string& name, Make make) {
  if (!track.is_array() || track.empty() || track.size() > 1000) throw BadClip{"\"" + name + "\" has no keys"};
  Keys<T> keys;
  for (const json& key : track) {
    const std::vector<float> v = numbers(key, count, name);
    if (!keys.empty() && v[0] <= keys.back().first) throw BadClip{"the times of \"" + name + "\" do not grow"};
    keys.emplace_back(v[0], make(v));
  }
  return keys;
}

HandKey hand_key(const std::vector<float>& v) {
  const Vector3f fingers(v[4], v[5], v[6]);
  const Vector3f palm(v[7], v[8], v[9]);
  if (fingers.cross(palm).norm() < 0.05F) throw BadClip{"fingers and palm of a hand point the same way"};
  const Vector3f x = fingers.normalized();
  const Vector3f z = (-palm + x * x.dot(palm)).normalized();
  Eigen::Matrix3f R;
  R << x, z.cross(x), z;
  return {{v[1], v[2], v[3]}, Quaternionf(R)};
}

Keys<HandShape> shape_keys(const json& track, const std::string& name) {
  if (!track.is_array() || track.empty() || track.size() > 1000) throw BadClip{"\"" + name + "\" has no keys"};
  Keys<HandShape> keys;
  for (const json& key : track) {
    const float time = key.at(0).get<float>();
    if (!keys.empty() && time <= keys.back().first) throw BadClip{"the times of \"" + name + "\" do not grow"};
    keys.emplace_back(time, hand_shape(key.at(1).get<std::string>()));
  }
  return keys;
}

void read_track(const std::string& name, const json& track, Clip& clip) {
  const auto turn = [](const std::vector<float>& v) { return Turn{radians(v[1]), radians(v[2]), radians(v[3])}; };
  if (name == "head") {
    clip.head = keys_of<Turn>(track, 3, name, turn);
  } else if (name == "spine") {
    clip.spine = keys_of<Turn>(track, 3, name, turn);
  } else if (name == "pelvis") {
    clip.pelvis = keys_of<Turn>(track, 3, name, turn);
  } else if (name == "shrug") {
    clip.shrug = keys_of<std::array<float, 2>>(track, 2, name, [](const auto& v) {
      return std::array<float, 2>{v[1], v[2]};
    });
  } else if (name.rfind("face.", 0) == 0) {
    clip.face[name.substr(5)] = keys_of<float>(track, 1, name, [](const auto& v) { return v[1]; });
  } else {
    const std::size_t side = name.rfind("left_", 0) == 0 ? left_side : right_side;
    const std::string what = name.substr(name.find('_') == std::string::npos ? 0 : name.find('_') + 1);
    const bool sided = name.rfind("left_", 0) == 0 || name.rfind("right_", 0) == 0;
    if (sided && what == "hand") {
      clip.hand[side] = keys_of<HandKey>(track, 9, name, hand_key);
    } else if (sided && what == "swivel") {
      clip.swivel[side] = keys_of<float>(track, 1, name, [](const auto& v) { return radians(v[1]); });
    } else if (sided && what == "shape") {
      clip.shape[side] = shape_keys(track, name);
    } else {
      throw BadClip{"there is no track \"" + name + "\""};
    }
  }
}

}  // namespace

unsigned Clip::parts() const {
  unsigned mask = 0;
  if (!head.empty()) mask |= part::head;
  if (!spine.empty() || !pelvis.empty() || !shrug.empty()) mask |= part::trunk;
  if (!face.empty()) mask |= part::face;
  if (!hand[left_side].empty()) mask |= part::left_arm;
  if (!hand[right_side].empty()) mask |= part::right_arm;
  return mask;
}

Result<Clip> parse_clip(std::string_view json_text) {
  const json from = json::parse(json_text, nullptr, false);
  if (!from.is_object()) return wrong("this is not a JSON object");
  try {
    Clip clip;
    clip.name = from.at("name").get<std::string>();
    clip.seconds = from.at("seconds").get<float>();
    if (!(clip.seconds > 0.05F && clip.seconds < 600)) return wrong("\"seconds\" has to be from 0.05 to 600");
    clip.yields = from.value("yields", false);
    clip.in_head_frame = from.value("frame", "chest") == "head";
    for (const auto& [name, track] : from.at("tracks").items()) read_track(name, track, clip);
    if (clip.parts() == 0) return wrong("\"" + clip.name + "\" moves nothing");
    return clip;
  } catch (const BadClip& bad) {
    return wrong(bad.what);
  } catch (const json::exception& e) {
    return wrong(e.what());
  }
}

void add_clip(const Clip& clip, float t, float weight, unsigned mask, BodyControls& c, const ClipVariation& variation) {
  const auto turned = [&](const Turn& turn) {
    const Turn shown = turn * weight;
    return variation.mirrored ? Turn{shown.pitch, -shown.roll, -shown.yaw} : shown;
  };
  if (!clip.head.empty() && (mask & part::head) != 0) {
    const float height = minimum_jerk(4 * t / clip.seconds) * minimum_jerk(4 - 4 * t / clip.seconds);
    c.head = c.head + turned(value_at(clip, clip.head, t)) + variation.head * (weight * height);
  }
  if ((mask & part::trunk) != 0) {
    if (!clip.spine.empty()) c.spine = c.spine + turned(value_at(clip, clip.spine, t));
    if (!clip.pelvis.empty()) c.pelvis = c.pelvis + turned(value_at(clip, clip.pelvis, t));
    if (!clip.shrug.empty()) {
      const auto shrug = value_at(clip, clip.shrug, t);
      for (const std::size_t s : {left_side, right_side}) c.shrug[s] += shrug[s] * weight;
    }
  }
  if ((mask & part::face) != 0) {
    for (const auto& [name, keys] : clip.face) c.morphs[name] += value_at(clip, keys, t) * weight;
  }
}

bool clip_hand(const Clip& clip, float t, std::size_t shown_side, const ClipFrame& frame, ArmGoal& goal,
               const ClipVariation& variation) {
  const std::size_t side = variation.mirrored ? 1 - shown_side : shown_side;
  if (clip.hand[side].empty() || !variation.hands) return false;
  HandKey key = value_at(clip, clip.hand[side], t);
  if (variation.mirrored) key = mirrored(key);
  goal.wrist_S = frame.origin_S + frame.R_S * (key.place * frame.arm_m + variation.place);
  goal.R_SW = (frame.R_S * key.rotation).normalized();
  goal.help = 0;
  goal.swivel_rad = clip.swivel[side].empty() ? 0 : value_at(clip, clip.swivel[side], t);
  goal.shape = clip.shape[side].empty() ? hand_shape("relaxed") : value_at(clip, clip.shape[side], t);
  return true;
}

}  // namespace counterpart
