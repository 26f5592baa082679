#include "vhd_renderer/motion/hand.hpp"

#include <algorithm>
#include <cmath>

#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Matrix3f;
using Eigen::Quaternionf;
using Eigen::Vector3f;

Quaternionf about(const Vector3f& axis, float angle) {
  return Quaternionf(AngleAxisf(angle, axis));
}

Quaternionf rotation(const Vector3f& vector) {
  const float angle = vector.norm();
  return angle < 1e-7F ? Quaternionf::Identity() : about(vector / angle, angle);
}

// Turns of a finger's three joints from bind, in H.
std::array<Quaternionf, 3> turns(const HandParts& hand, const HandShape& shape, std::size_t f) {
  const Finger& finger = hand.fingers[f];
  const FingerBend& bend = shape.fingers[f];
  std::array<Quaternionf, 3> q;
  for (std::size_t k = 0; k < 3; ++k) q[k] = about(finger.axis_H, bend.flex_rad[k] - finger.bind_flex_rad[k]);
  if (f == thumb) {
    // Written for a right hand; a left hand is its mirror image.
    const Vector3f mirrored(shape.thumb_turn_W.x() * hand.thumb_side, shape.thumb_turn_W.y(),
                            shape.thumb_turn_W.z() * hand.thumb_side);
    q[0] = rotation(hand.R_HW * mirrored);
  } else {
    q[0] = about(finger.spread_axis_H, bend.spread_rad) * q[0];
  }
  return q;
}

Vector3f bind_place(const Figure& figure, int joint) {
  return figure.joints[static_cast<std::size_t>(joint)].X_HJ.translation();
}

using Bones = std::array<Eigen::Isometry3f, 3>;

// A finger's bones: each takes points of H at bind to the hand frame W with the hand shaped.
Bones bones_W(const Figure& figure, const HandParts& hand, const HandShape& shape, std::size_t f) {
  const Finger& finger = hand.fingers[f];
  const auto q = turns(hand, shape, f);
  const Matrix3f R_WH = hand.R_HW.transpose();
  Quaternionf G = Quaternionf::Identity();
  Vector3f p = bind_place(figure, finger.joint[0]) - bind_place(figure, hand.wrist);
  Bones bones;
  for (std::size_t k = 0; k < 3; ++k) {
    G = G * q[k];
    bones[k].linear() = R_WH * G.toRotationMatrix();
    bones[k].translation() = R_WH * (p - G * bind_place(figure, finger.joint[k]));
    if (k < 2) p += G * (bind_place(figure, finger.joint[k + 1]) - bind_place(figure, finger.joint[k]));
  }
  return bones;
}

}  // namespace

HandShape blend(const HandShape& a, const HandShape& b, float t) {
  HandShape c;
  for (std::size_t f = 0; f < 5; ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      c.fingers[f].flex_rad[k] = lerp(a.fingers[f].flex_rad[k], b.fingers[f].flex_rad[k], t);
    }
    c.fingers[f].spread_rad = lerp(a.fingers[f].spread_rad, b.fingers[f].spread_rad, t);
  }
  c.thumb_turn_W = a.thumb_turn_W + (b.thumb_turn_W - a.thumb_turn_W) * t;
  return c;
}

HandShape hand_shape(const std::string& name) {
  const auto shape = [](Vector3f thumb_turn, float thumb_bend, std::array<std::array<float, 3>, 4> degrees) {
    HandShape s;
    s.thumb_turn_W = thumb_turn;
    s.fingers[thumb].flex_rad = {0, radians(thumb_bend), radians(thumb_bend)};
    for (std::size_t f = 0; f < 4; ++f) {
      for (std::size_t k = 0; k < 3; ++k) s.fingers[f + 1].flex_rad[k] = radians(degrees[f][k]);
    }
    return s;
  };
  if (name == "flat" || name == "open") {
    HandShape s = shape({0, 0, 0}, 4, {{{4, 5, 3}, {4, 5, 3}, {4, 6, 3}, {4, 7, 3}}});
    if (name == "open") {
      s.fingers[index_finger].spread_rad = radians(8);
      s.fingers[little_finger].spread_rad = radians(-10);
      s.fingers[ring_finger].spread_rad = radians(-4);
    }
    return s;
  }
  if (name == "fist")
    return shape({0.25F, 0.35F, -0.2F}, 35, {{{75, 95, 55}, {78, 98, 55}, {80, 98, 55}, {80, 95, 55}}});
  if (name == "point") return shape({0.25F, 0.3F, -0.2F}, 30, {{{8, 6, 4}, {70, 85, 45}, {74, 88, 45}, {76, 88, 45}}});
  if (name == "thumb_up")
    return shape({-0.2F, -0.2F, 0.2F}, 2, {{{75, 95, 55}, {78, 98, 55}, {80, 98, 55}, {80, 95, 55}}});
  if (name == "chin") return shape({0.0F, 0.0F, 0.0F}, 10, {{{28, 30, 14}, {55, 62, 30}, {62, 70, 35}, {65, 70, 35}}});
  if (name == "tap_a") return shape({0.05F, 0.05F, 0}, 10, {{{2, 26, 12}, {30, 34, 14}, {10, 31, 16}, {38, 36, 17}}});
  if (name == "tap_b") return shape({0.05F, 0.05F, 0}, 10, {{{30, 30, 12}, {4, 28, 14}, {36, 34, 16}, {12, 33, 17}}});
  if (name == "rest") return shape({0.1F, 0.1F, 0}, 6, {{{9, 14, 8}, {10, 16, 9}, {11, 18, 10}, {12, 20, 11}}});
  if (name == "grip")
    return shape({0.35F, 0.25F, -0.1F}, 15, {{{42, 30, 16}, {46, 32, 18}, {62, 60, 30}, {66, 66, 32}}});
  return shape({0.05F, 0.05F, 0}, 10, {{{18, 24, 12}, {22, 28, 14}, {25, 31, 16}, {27, 33, 17}}});
}

void apply(const Figure& figure, const HandParts& hand, const HandShape& shape, BodyPose& pose) {
  for (std::size_t f = 0; f < 5; ++f) {
    const auto q = turns(hand, shape, f);
    for (std::size_t k = 0; k < 3; ++k) pose.turn[static_cast<std::size_t>(hand.fingers[f].joint[k])] = q[k];
  }
  update_chain(figure, pose, hand.below);
}

Fingertip fingertip_W(const Figure& figure, const HandParts& hand, const HandShape& shape, std::size_t f) {
  const Finger& finger = hand.fingers[f];
  const Eigen::Isometry3f last = bones_W(figure, hand, shape, f)[2];
  return {last * finger.pad_H, last.linear() * finger.pad_normal_H, last * finger.tip_H};
}

HandSkin::HandSkin(const Figure& figure, const HandParts& hand) : figure_(&figure), hand_(&hand) {
  // Where a joint's influence goes: -1 another part of the body, 0 the palm, else 1 + 3 * finger + bone.
  std::vector<int> place(figure.joints.size(), -1);
  place[at(hand.wrist)] = 0;
  for (const int j : hand.below) place[at(j)] = 0;
  for (std::size_t f = 0; f < 5; ++f) {
    for (std::size_t k = 0; k < 3; ++k) place[at(hand.fingers[f].joint[k])] = static_cast<int>(1 + 3 * f + k);
  }
  for (const FigurePart& part : figure.parts) {
    for (std::size_t v = 0; v < part.positions_m.size(); ++v) add(part, v, place);
  }
}

void HandSkin::add(const FigurePart& part, std::size_t v, const std::vector<int>& place) {
  Vertex vertex{part.positions_m[v], {}, part.weights[v]};
  std::array<float, parts> share{};
  float inside = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const int where = place[part.joints[v][k]];
    vertex.bones[k] = static_cast<std::uint8_t>(std::max(0, where));
    if (where < 0) continue;
    inside += part.weights[v][k];
    share[where == 0 ? palm : static_cast<std::size_t>(where - 1) / 3] += part.weights[v][k];
  }
  if (inside < 0.5F) return;
  vertices_[static_cast<std::size_t>(std::max_element(share.begin(), share.end()) - share.begin())].push_back(vertex);
}

std::array<std::vector<Vector3f>, HandSkin::parts> HandSkin::places_W(const HandShape& shape) const {
  std::array<Eigen::Matrix4f, 16> M;
  Eigen::Isometry3f flat = Eigen::Isometry3f::Identity();
  flat.linear() = hand_->R_HW.transpose();
  flat.translation() = -flat.linear() * bind_place(*figure_, hand_->wrist);
  M[0] = flat.matrix();
  for (std::size_t f = 0; f < 5; ++f) {
    const Bones bones = bones_W(*figure_, *hand_, shape, f);
    for (std::size_t k = 0; k < 3; ++k) M[1 + 3 * f + k] = bones[k].matrix();
  }
  std::array<std::vector<Vector3f>, parts> places;
  for (std::size_t part = 0; part < parts; ++part) {
    places[part].reserve(vertices_[part].size());
    for (const Vertex& v : vertices_[part]) {
      Vector3f p = Vector3f::Zero();
      for (std::size_t k = 0; k < 4 && v.weights[k] > 0; ++k) {
        const Eigen::Matrix4f& m = M[v.bones[k]];
        p += v.weights[k] * (m.topLeftCorner<3, 3>() * v.p_H + m.topRightCorner<3, 1>());
      }
      places[part].push_back(p);
    }
  }
  return places;
}

}  // namespace counterpart
