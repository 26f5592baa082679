#include "vhd_renderer/body/joint_names.hpp"

#include <array>
#include <optional>
#include <unordered_map>

namespace counterpart {
namespace {

struct Row {
  const char* hanim;
  const char* makehuman;
  const char* mixamo;
  const char* vroid;
};

constexpr std::array<Row, 13> trunk_rows{{
    {"HumanoidRoot", "root", "Hips", "Hips"},
    {"vl5", "spine05", "", ""},
    {"vl2", "spine04", "Spine", "Spine"},
    {"vt12", "spine03", "Spine1", "Chest"},
    {"vt6", "spine02", "Spine2", "UpperChest"},
    {"vt1", "spine01", "", ""},
    {"vc7", "neck01", "Neck", "Neck"},
    {"vc4", "neck02", "", ""},
    {"vc2", "neck03", "", ""},
    {"skullbase", "head", "Head", "Head"},
    {"temporomandibular", "jaw", "Jaw", "Jaw"},
    {"tongue", "tongue00", "", ""},
    {"skull_tip", "", "HeadTop_End", ""},
}};

constexpr std::array<Row, 36> sided{{
    {"hip_girdle", "pelvis", "", ""},
    {"hip", "upperleg01", "UpLeg", "UpperLeg"},
    {"thigh_twist", "upperleg02", "", ""},
    {"knee", "lowerleg01", "Leg", "LowerLeg"},
    {"shin_twist", "lowerleg02", "", ""},
    {"ankle", "foot", "Foot", "Foot"},
    {"midtarsal", "toe1-1", "ToeBase", "ToeBase"},
    {"eyeball_joint", "eye", "Eye", "Eye"},
    {"sternoclavicular", "clavicle", "Shoulder", "Shoulder"},
    {"acromioclavicular", "shoulder01", "", ""},
    {"shoulder", "upperarm01", "Arm", "UpperArm"},
    {"upperarm_twist", "upperarm02", "", ""},
    {"elbow", "lowerarm01", "ForeArm", "LowerArm"},
    {"forearm_twist", "lowerarm02", "", ""},
    {"wrist", "wrist", "Hand", "Hand"},
    {"thumb1", "finger1-1", "HandThumb1", "Thumb1"},
    {"thumb2", "finger1-2", "HandThumb2", "Thumb2"},
    {"thumb3", "finger1-3", "HandThumb3", "Thumb3"},
    {"index0", "metacarpal1", "", ""},
    {"index1", "finger2-1", "HandIndex1", "Index1"},
    {"index2", "finger2-2", "HandIndex2", "Index2"},
    {"index3", "finger2-3", "HandIndex3", "Index3"},
    {"middle0", "metacarpal2", "", ""},
    {"middle1", "finger3-1", "HandMiddle1", "Middle1"},
    {"middle2", "finger3-2", "HandMiddle2", "Middle2"},
    {"middle3", "finger3-3", "HandMiddle3", "Middle3"},
    {"ring0", "metacarpal3", "", ""},
    {"ring1", "finger4-1", "HandRing1", "Ring1"},
    {"ring2", "finger4-2", "HandRing2", "Ring2"},
    {"ring3", "finger4-3", "HandRing3", "Ring3"},
    {"pinky0", "metacarpal4", "", ""},
    {"pinky1", "finger5-1", "HandPinky1", "Little1"},
    {"pinky2", "finger5-2", "HandPinky2", "Little2"},
    {"pinky3", "finger5-3", "HandPinky3", "Little3"},
    {"upper_lid", "orbicularis03", "", ""},
    {"lower_lid", "orbicularis04", "", ""},
}};

std::unordered_map<std::string, std::string> all_names() {
  std::unordered_map<std::string, std::string> names;
  const auto put = [&](const std::string& source, const std::string& hanim) {
    if (!source.empty()) names.emplace(source, hanim);
  };
  for (const Row& row : trunk_rows) {
    put(row.makehuman, row.hanim);
    put(row.mixamo, row.hanim);
    if (*row.vroid != '\0') put(std::string("J_Bip_C_") + row.vroid, row.hanim);
  }
  for (const Row& row : sided) {
    for (const bool left : {true, false}) {
      const std::string hanim = std::string(left ? "l_" : "r_") + row.hanim;
      if (*row.makehuman != '\0') put(row.makehuman + std::string(left ? ".L" : ".R"), hanim);
      if (*row.mixamo != '\0') put((left ? "Left" : "Right") + std::string(row.mixamo), hanim);
      if (*row.vroid != '\0') put(std::string(left ? "J_Bip_L_" : "J_Bip_R_") + row.vroid, hanim);
    }
  }
  return names;
}

}  // namespace

std::string hanim_name(std::string_view source_name) {
  static const std::unordered_map<std::string, std::string> names = all_names();
  std::string_view name = source_name;
  if (const std::size_t colon = name.rfind(':'); colon != std::string_view::npos) name.remove_prefix(colon + 1);
  const auto found = names.find(std::string(name));
  return found == names.end() ? std::string(source_name) : found->second;
}

}  // namespace counterpart
