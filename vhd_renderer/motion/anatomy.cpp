#include "vhd_renderer/motion/anatomy.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace counterpart {
namespace {

using Eigen::Vector3f;

struct Names {
  const Figure& figure;
  std::unordered_map<std::string, int> index;
  std::string missing;

  explicit Names(const Figure& f) : figure(f) {
    for (std::size_t i = 0; i < f.joints.size(); ++i) index.emplace(f.joints[i].name, static_cast<int>(i));
  }

  int optional(const std::string& name) const {
    const auto found = index.find(name);
    return found == index.end() ? -1 : found->second;
  }

  int required(const std::string& name) {
    const int i = optional(name);
    if (i < 0 && missing.empty()) missing = name;
    return i;
  }

  Vector3f place(int joint) const {
    return joint < 0 ? Vector3f::Zero() : Vector3f(figure.joints[static_cast<std::size_t>(joint)].X_HJ.translation());
  }

  std::vector<int> below(int top) const {
    std::vector<int> joints;
    std::vector<bool> inside(figure.joints.size(), false);
    for (std::size_t j = 0; j < figure.joints.size(); ++j) {
      const int parent = figure.joints[j].parent;
      inside[j] = parent >= 0 && (parent == top || inside[static_cast<std::size_t>(parent)]);
      if (inside[j]) joints.push_back(static_cast<int>(j));
    }
    return joints;
  }

  std::vector<int> chain(int from, int to) const {
    std::vector<int> joints;
    for (int j = to; j >= 0; j = figure.joints[static_cast<std::size_t>(j)].parent) {
      joints.push_back(j);
      if (j == from) break;
    }
    std::reverse(joints.begin(), joints.end());
    return joints;
  }
};

Limb limb_of(Names& names, const std::string& root, const std::string& root_twist, const std::string& middle,
             const std::string& middle_twist, const std::string& end, const Vector3f& straight_hinge) {
  Limb limb;
  limb.root = names.required(root);
  limb.root_twist = names.optional(root_twist);
  limb.middle = names.required(middle);
  limb.middle_twist = names.optional(middle_twist);
  limb.end = names.required(end);
  const Vector3f upper = names.place(limb.middle) - names.place(limb.root);
  const Vector3f lower = names.place(limb.end) - names.place(limb.middle);
  limb.upper_m = upper.norm();
  limb.lower_m = lower.norm();
  if (limb.upper_m > 0 && limb.lower_m > 0) {
    limb.upper_H = upper / limb.upper_m;
    limb.lower_H = lower / limb.lower_m;
  }
  // A limb bound straight has no plane of its own; then the usual hinge counts.
  const Vector3f own = limb.upper_H.cross(limb.lower_H);
  const bool bent = own.norm() > 0.09F && own.normalized().dot(straight_hinge) > 0.3F;
  const Vector3f hinge = bent ? own : straight_hinge;
  limb.hinge_H = (hinge - limb.upper_H * limb.upper_H.dot(hinge)).normalized();
  return limb;
}

// Flesh of the last bone: how far it goes, and where its pad is.
void measure_pad(const Figure& figure, const Vector3f& base, const Vector3f& bone_end, Finger& finger) {
  const Vector3f along = (bone_end - base).normalized();
  const Vector3f palmar = finger.axis_H.cross(along).normalized();
  float reach = (bone_end - base).norm();
  std::vector<Vector3f> flesh;
  for (const FigurePart& part : figure.parts) {
    for (std::size_t v = 0; v < part.positions_m.size(); ++v) {
      float weight = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        if (part.joints[v][k] == finger.joint[2]) weight += part.weights[v][k];
      }
      if (weight > 0.5F) flesh.push_back(part.positions_m[v]);
    }
  }
  for (const Vector3f& p : flesh) reach = std::max(reach, (p - base).dot(along));
  float thickness = 0;
  for (const Vector3f& p : flesh) {
    const float share = (p - base).dot(along) / reach;
    if (share > 0.55F && share < 0.85F) thickness = std::max(thickness, (p - base).dot(palmar));
  }
  if (thickness <= 0) thickness = 0.007F;
  finger.tip_H = base + along * reach;
  finger.pad_H = base + along * (reach * 0.72F) + palmar * thickness;
  finger.pad_normal_H = palmar;
}

void add_finger(Names& names, const std::string& side, const char* name, HandParts& hand, Finger& finger) {
  for (std::size_t k = 0; k < 3; ++k) finger.joint[k] = names.required(side + name + std::to_string(k + 1));
  const Vector3f a = names.place(finger.joint[0]);
  const Vector3f b = names.place(finger.joint[1]);
  const Vector3f c = names.place(finger.joint[2]);
  const int tip = names.optional(side + name + "_distal_tip");
  const Vector3f end = tip >= 0 ? names.place(tip) : Vector3f(c + (c - b) * 0.85F);
  const Vector3f x = hand.R_HW.col(0);
  const Vector3f z = hand.R_HW.col(2);
  if (std::string(name) == "thumb") {
    // The thumb bends across the palm, towards the root of the little finger.
    const Vector3f across = names.place(names.required(side + "pinky1")) - c;
    finger.axis_H = (c - b).cross(across).normalized();
    finger.spread_axis_H = z;
    finger.bind_flex_rad = {0, 0, 0};
  } else {
    finger.axis_H = z.cross((c - a).normalized()).normalized();
    finger.spread_axis_H = z * hand.thumb_side;
    const auto bend = [&](const Vector3f& from, const Vector3f& to) {
      return std::atan2(from.cross(to).dot(finger.axis_H), from.dot(to));
    };
    finger.bind_flex_rad = {bend(x, (b - a).normalized()), bend((b - a).normalized(), (c - b).normalized()),
                            bend((c - b).normalized(), (end - c).normalized())};
  }
  measure_pad(names.figure, c, end, finger);
}

ArmParts arm_of(Names& names, const std::string& side, bool right) {
  ArmParts arm;
  arm.clavicle = names.optional(side + "sternoclavicular");
  // With the palm turned forward or inward an elbow closes towards the front; this hinge serves arms bound straight.
  const Vector3f usual = right ? Vector3f(0.7F, 0, 0.7F) : Vector3f(0.7F, 0, -0.7F);
  arm.limb = limb_of(names, side + "shoulder", side + "upperarm_twist", side + "elbow", side + "forearm_twist",
                     side + "wrist", usual);
  if (arm.clavicle >= 0) arm.girdle = names.chain(arm.clavicle, arm.limb.root);
  HandParts& hand = arm.hand;
  hand.wrist = arm.limb.end;
  hand.below = names.below(hand.wrist);
  const Vector3f wrist = names.place(hand.wrist);
  const Vector3f middle = names.place(names.required(side + "middle1"));
  const Vector3f radial = names.place(names.required(side + "index1")) - names.place(names.required(side + "pinky1"));
  const Vector3f x = (middle - wrist).normalized();
  const Vector3f z = (right ? Vector3f(x.cross(radial)) : Vector3f(radial.cross(x))).normalized();
  hand.R_HW << x, z.cross(x), z;
  hand.thumb_side = hand.R_HW.col(1).dot(radial) > 0 ? 1.F : -1.F;
  constexpr std::array<const char*, 5> fingers{"thumb", "index", "middle", "ring", "pinky"};
  for (std::size_t f = 0; f < 5; ++f) add_finger(names, side, fingers[f], hand, hand.fingers[f]);
  return arm;
}

LegParts leg_of(Names& names, const std::string& side) {
  LegParts leg;
  leg.limb = limb_of(names, side + "hip", side + "thigh_twist", side + "knee", side + "shin_twist", side + "ankle",
                     {-1, 0, 0});
  leg.toe = names.optional(side + "midtarsal");
  for (std::size_t j = 0; j < names.figure.joints.size() && leg.toe >= 0; ++j) {
    if (names.figure.joints[j].parent == leg.limb.end) leg.toes.push_back(static_cast<int>(j));
  }
  const Vector3f ankle = names.place(leg.limb.end);
  leg.ankle_height_m = ankle.z();
  const Vector3f toe = leg.toe >= 0 ? names.place(leg.toe) : Vector3f(ankle + Vector3f(0, 0.13F, 0));
  leg.ball_H = {toe.x(), toe.y(), 0};
  // The sole's end, as far as it lies on the floor.
  for (const FigurePart& part : names.figure.parts) {
    for (const Vector3f& p : part.positions_m) {
      const bool sole = p.z() < 0.006F && std::abs(p.x() - toe.x()) < 0.08F;
      if (sole) leg.toe_length_m = std::max(leg.toe_length_m, p.y() - toe.y());
    }
  }
  return leg;
}

}  // namespace

Result<Anatomy> anatomy_of(const Figure& figure) {
  Names names(figure);
  Anatomy a;
  a.root = names.required("HumanoidRoot");
  const int neck = names.required("vc7");
  const int head = names.required("skullbase");
  for (const std::size_t s : {left_side, right_side}) {
    const std::string side = s == left_side ? "l_" : "r_";
    a.arms[s] = arm_of(names, side, s == right_side);
    a.legs[s] = leg_of(names, side);
    a.eyes[s] = names.optional(side + "eyeball_joint");
  }
  if (!names.missing.empty()) {
    return failure(ErrorCode::unsupported, "the figure " + figure.name + " has no joint \"" + names.missing +
                                               "\"; rename its joints to H-Anim, Mixamo or VRM names");
  }
  a.jaw = names.optional("temporomandibular");
  a.trunk = names.chain(a.root, figure.joints[static_cast<std::size_t>(neck)].parent);
  a.spine.assign(a.trunk.begin() + (a.trunk.empty() ? 0 : 1), a.trunk.end());
  a.neck = names.chain(neck, head);
  if (a.trunk.empty() || a.trunk.front() != a.root || a.spine.empty() || a.neck.front() != neck) {
    return failure(ErrorCode::unsupported, "the spine of the figure " + figure.name + " does not start at its root");
  }
  const Vector3f hip = names.place(a.legs[0].limb.root);
  a.hip_height_m = hip.z();
  for (const FigurePart& part : figure.parts) {
    for (const Vector3f& p : part.positions_m) {
      const bool belly = std::abs(p.x()) < 0.08F && p.z() > hip.z() + 0.04F && p.z() < hip.z() + 0.22F;
      if (belly) a.belly_m = std::max(a.belly_m, p.y() - hip.y());
    }
  }
  return a;
}

}  // namespace counterpart
