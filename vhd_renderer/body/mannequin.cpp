#include "vhd_renderer/body/mannequin.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <unordered_map>

namespace counterpart {
namespace {

using Eigen::Vector3f;

struct Builder {
  Figure figure;
  std::unordered_map<std::string, int> index;

  void joint(const std::string& name, const std::string& parent, const Vector3f& p_H) {
    Joint one;
    one.name = name;
    one.parent = parent.empty() ? -1 : index.at(parent);
    one.X_HJ.translation() = p_H;
    one.X_PJ.translation() = parent.empty() ? p_H : Vector3f(p_H - place(parent));
    index[name] = static_cast<int>(figure.joints.size());
    figure.joints.push_back(std::move(one));
  }

  Vector3f place(const std::string& name) const {
    return figure.joints[static_cast<std::size_t>(index.at(name))].X_HJ.translation();
  }
};

void add_trunk(Builder& b) {
  b.joint("HumanoidRoot", "", {0, 0, 0.95F});
  b.joint("vl5", "HumanoidRoot", {0, -0.01F, 0.99F});
  b.joint("vl2", "vl5", {0, 0.0F, 1.09F});
  b.joint("vt12", "vl2", {0, 0.0F, 1.19F});
  b.joint("vt6", "vt12", {0, -0.01F, 1.29F});
  b.joint("vt1", "vt6", {0, -0.02F, 1.41F});
  b.joint("vc7", "vt1", {0, -0.015F, 1.47F});
  b.joint("vc4", "vc7", {0, -0.005F, 1.51F});
  b.joint("skullbase", "vc4", {0, 0.0F, 1.555F});
  b.joint("temporomandibular", "skullbase", {0, 0.03F, 1.56F});
}

void add_leg(Builder& b, const std::string& side, float s) {
  b.joint(side + "hip", "HumanoidRoot", {s * 0.09F, 0, 0.92F});
  b.joint(side + "knee", side + "hip", {s * 0.095F, 0.015F, 0.49F});
  b.joint(side + "ankle", side + "knee", {s * 0.10F, -0.015F, 0.085F});
  b.joint(side + "midtarsal", side + "ankle", {s * 0.105F, 0.12F, 0.025F});
}

struct Finger {
  const char* name;
  Vector3f root;  // along the hand, towards the thumb, out of the palm
  Vector3f direction;
  std::array<float, 3> lengths;
};

void add_hand(Builder& b, const std::string& side, float s, const Vector3f& along) {
  const Vector3f wrist = b.place(side + "wrist");
  const Vector3f radial = (Vector3f::UnitY() - along * along.y()).normalized();
  const Vector3f dorsal = s > 0 ? Vector3f(along.cross(radial)) : Vector3f(radial.cross(along));
  const auto in_H = [&](const Vector3f& v) { return Vector3f(along * v.x() + radial * v.y() - dorsal * v.z()); };
  const std::array<Finger, 5> fingers{{
      {"thumb", {0.022F, 0.028F, 0.012F}, {0.66F, 0.55F, 0.51F}, {0.044F, 0.032F, 0.026F}},
      {"index", {0.088F, 0.026F, 0.0F}, {1, 0.04F, 0.12F}, {0.042F, 0.026F, 0.023F}},
      {"middle", {0.091F, 0.005F, 0.0F}, {1, 0, 0.12F}, {0.046F, 0.029F, 0.023F}},
      {"ring", {0.086F, -0.015F, 0.0F}, {1, -0.03F, 0.12F}, {0.042F, 0.027F, 0.023F}},
      {"pinky", {0.078F, -0.034F, 0.0F}, {1, -0.07F, 0.12F}, {0.034F, 0.021F, 0.020F}},
  }};
  for (const Finger& finger : fingers) {
    std::string parent = side + "wrist";
    Vector3f p = wrist + in_H(finger.root);
    Vector3f direction = in_H(finger.direction).normalized();
    const Vector3f axis = dorsal.cross(direction).normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string name = side + finger.name + std::to_string(k + 1);
      b.joint(name, parent, p);
      p += direction * finger.lengths[k];
      direction = Eigen::AngleAxisf(0.12F, axis) * direction;  // a hand at rest is never flat
      parent = name;
    }
    b.joint(side + finger.name + "_distal_tip", parent, p);
  }
}

void add_arm(Builder& b, const std::string& side, float s) {
  b.joint(side + "sternoclavicular", "vt1", {s * 0.02F, 0.03F, 1.41F});
  b.joint(side + "shoulder", side + "sternoclavicular", {s * 0.175F, -0.015F, 1.42F});
  const Vector3f upper = Vector3f(s * 0.60F, -0.02F, -0.80F).normalized();
  const Vector3f fore = Vector3f(s * 0.50F, 0.34F, -0.80F).normalized();
  const Vector3f elbow = b.place(side + "shoulder") + upper * 0.29F;
  b.joint(side + "elbow", side + "shoulder", elbow);
  b.joint(side + "forearm_twist", side + "elbow", elbow + fore * 0.13F);
  b.joint(side + "wrist", side + "forearm_twist", elbow + fore * 0.255F);
  add_hand(b, side, s, fore);
}

struct Shape {
  FigurePart& part;

  // A capsule from a to b, rigid on one joint.
  void capsule(int joint, const Vector3f& a, const Vector3f& b, float ra, float rb, float flat = 1.F) {
    constexpr int around = 14;
    constexpr int caps = 4;
    Vector3f axis = b - a;
    const float length = axis.norm();
    axis = length > 1e-6F ? Vector3f(axis / length) : Vector3f::UnitZ();
    const Vector3f side = std::abs(axis.x()) < 0.9F ? Vector3f(axis.cross(Vector3f::UnitX()).normalized() * -1)
                                                    : Vector3f(axis.cross(Vector3f::UnitZ()).normalized());
    const Vector3f other = axis.cross(side);
    const auto first = static_cast<std::uint32_t>(part.positions_m.size());
    int rings = 0;
    for (int half = 0; half < 2; ++half) {
      for (int k = 0; k <= caps; ++k, ++rings) {
        const float t = std::numbers::pi_v<float> / 2 * static_cast<float>(half == 0 ? k - caps : k) / caps;
        const Vector3f& centre = half == 0 ? a : b;
        const float r = half == 0 ? ra : rb;
        for (int i = 0; i < around; ++i) {
          const float phi = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / around;
          const Vector3f n = axis * std::sin(t) + (side * std::cos(phi) + other * std::sin(phi)) * std::cos(t);
          Vector3f p = n * r;
          p.y() *= flat;
          part.positions_m.push_back(centre + p);
          part.normals.push_back(Vector3f(n.x(), n.y() / flat, n.z()).normalized());
          part.uvs.emplace_back(0.F, 0.F);
          part.joints.push_back({static_cast<std::uint16_t>(joint), 0, 0, 0});
          part.weights.push_back({1, 0, 0, 0});
        }
      }
    }
    for (int ring = 0; ring + 1 < rings; ++ring) {
      for (int i = 0; i < around; ++i) {
        const auto at = [&](int r, int k) { return first + static_cast<std::uint32_t>(r * around + k % around); };
        for (const std::uint32_t v :
             {at(ring, i), at(ring, i + 1), at(ring + 1, i + 1), at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)}) {
          part.triangles.push_back(v);
        }
      }
    }
  }
};

void cover_hand(const Builder& b, const std::string& side, Shape& shape) {
  const auto joint = [&](const std::string& name) { return b.index.at(side + name); };
  const auto place = [&](const std::string& name) { return b.place(side + name); };
  for (const char* finger : {"index", "middle", "ring", "pinky"}) {
    const std::string f = finger;
    shape.capsule(joint("wrist"), place("wrist") * 0.7F + place(f + "1") * 0.3F, place(f + "1"), 0.014F, 0.011F);
  }
  for (const char* finger : {"thumb", "index", "middle", "ring", "pinky"}) {
    const std::string f = finger;
    const float r = f == "thumb" ? 0.0095F : f == "pinky" ? 0.0070F : 0.0080F;
    shape.capsule(joint(f + "1"), place(f + "1"), place(f + "2"), r * 1.15F, r);
    shape.capsule(joint(f + "2"), place(f + "2"), place(f + "3"), r, r);
    const Vector3f inset = (place(f + "3") - place(f + "_distal_tip")).normalized() * (r * 0.85F);
    shape.capsule(joint(f + "3"), place(f + "3"), place(f + "_distal_tip") + inset, r, r * 0.85F);
  }
}

void cover(const Builder& b, Shape& shape) {
  const auto bone = [&](const char* from, const char* to, float ra, float rb, float flat = 1.F) {
    shape.capsule(b.index.at(from), b.place(from), b.place(to), ra, rb, flat);
  };
  shape.capsule(b.index.at("HumanoidRoot"), {-0.07F, -0.01F, 0.95F}, {0.07F, -0.01F, 0.95F}, 0.10F, 0.10F);
  bone("vl5", "vl2", 0.125F, 0.12F, 0.75F);
  bone("vl2", "vt12", 0.12F, 0.125F, 0.75F);
  bone("vt12", "vt6", 0.125F, 0.135F, 0.75F);
  shape.capsule(b.index.at("vt6"), {-0.06F, 0, 1.32F}, {0.06F, 0, 1.32F}, 0.10F, 0.10F);
  shape.capsule(b.index.at("vt1"), {-0.09F, -0.01F, 1.40F}, {0.09F, -0.01F, 1.40F}, 0.065F, 0.065F);
  bone("vc7", "skullbase", 0.052F, 0.05F);
  shape.capsule(b.index.at("skullbase"), {0, 0.025F, 1.60F}, {0, 0.015F, 1.665F}, 0.075F, 0.085F, 1.15F);
  shape.capsule(b.index.at("temporomandibular"), {0, 0.055F, 1.565F}, {0, 0.06F, 1.575F}, 0.04F, 0.045F);
  shape.capsule(b.index.at("skullbase"), {0, 0.107F, 1.61F}, {0, 0.098F, 1.64F}, 0.014F, 0.009F);
  for (const std::string side : {"l_", "r_"}) {
    bone((side + "hip").c_str(), (side + "knee").c_str(), 0.085F, 0.058F);
    bone((side + "knee").c_str(), (side + "ankle").c_str(), 0.056F, 0.040F);
    const Vector3f ankle = b.place(side + "ankle");
    shape.capsule(b.index.at(side + "ankle"), ankle + Vector3f(0, -0.035F, -0.045F),
                  b.place(side + "midtarsal") + Vector3f(0, 0, 0.01F), 0.04F, 0.035F);
    shape.capsule(b.index.at(side + "midtarsal"), b.place(side + "midtarsal") + Vector3f(0, 0, 0.005F),
                  b.place(side + "midtarsal") + Vector3f(0, 0.055F, 0.0F), 0.03F, 0.025F);
    bone((side + "sternoclavicular").c_str(), (side + "shoulder").c_str(), 0.05F, 0.06F);
    bone((side + "shoulder").c_str(), (side + "elbow").c_str(), 0.052F, 0.040F);
    bone((side + "elbow").c_str(), (side + "forearm_twist").c_str(), 0.040F, 0.035F);
    bone((side + "forearm_twist").c_str(), (side + "wrist").c_str(), 0.035F, 0.026F);
    cover_hand(b, side, shape);
  }
}

void add_eyes(Builder& b) {
  for (const float s : {-1.F, 1.F}) {
    const std::string side = s < 0 ? "l_" : "r_";
    const Vector3f centre(s * 0.031F, 0.088F, 1.645F);
    b.joint(side + "eyeball_joint", "skullbase", centre);
    FigurePart eye;
    eye.name = side + "eye";
    eye.colour = {0.9F, 0.9F, 0.88F};
    Shape shape{eye};
    shape.capsule(b.index.at(side + "eyeball_joint"), centre, centre, 0.0155F, 0.0155F);
    b.figure.parts.push_back(eye);
    FigurePart pupil;
    pupil.name = side + "pupil";
    pupil.colour = {0.03F, 0.03F, 0.035F};
    Shape dot{pupil};
    dot.capsule(b.index.at(side + "eyeball_joint"), centre + Vector3f(0, 0.0115F, 0), centre + Vector3f(0, 0.0115F, 0),
                0.0062F, 0.0062F);
    b.figure.parts.push_back(pupil);
  }
}

}  // namespace

Figure mannequin() {
  Builder b;
  b.figure.name = "mannequin";
  add_trunk(b);
  for (const float s : {-1.F, 1.F}) {
    const std::string side = s < 0 ? "l_" : "r_";
    add_leg(b, side, s);
    add_arm(b, side, s);
  }
  FigurePart wood;
  wood.name = "mannequin";
  wood.colour = {0.62F, 0.45F, 0.29F};
  Shape shape{wood};
  cover(b, shape);
  b.figure.parts.push_back(std::move(wood));
  add_eyes(b);
  float lowest = 1;
  for (const Vector3f& p : b.figure.parts.front().positions_m) lowest = std::min(lowest, p.z());
  for (FigurePart& part : b.figure.parts) {
    for (Vector3f& p : part.positions_m) p.z() -= lowest;
  }
  for (Joint& joint : b.figure.joints) {
    joint.X_HJ.translation().z() -= lowest;
    if (joint.parent < 0) joint.X_PJ.translation().z() -= lowest;
  }
  return b.figure;
}

}  // namespace counterpart
