#include "vhd_renderer/motion/hand.hpp"

#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Cholesky>

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

// A finger's last bone: takes points of H at bind to H with the hand shaped, the wrist's bind place at the origin.
Eigen::Isometry3f last_bone(const Figure& figure, const HandParts& hand, const HandShape& shape, std::size_t f) {
  const Finger& finger = hand.fingers[f];
  const auto q = turns(hand, shape, f);
  Quaternionf G = Quaternionf::Identity();
  Vector3f p = bind_place(figure, finger.joint[0]) - bind_place(figure, hand.wrist);
  for (std::size_t k = 0; k < 3; ++k) {
    G = G * q[k];
    if (k < 2) p += G * (bind_place(figure, finger.joint[k + 1]) - bind_place(figure, finger.joint[k]));
  }
  Eigen::Isometry3f X = Eigen::Isometry3f::Identity();
  X.linear() = G.toRotationMatrix();
  X.translation() = p - G * bind_place(figure, finger.joint[2]);
  return X;
}

// The skin of a finger's last bone at bind, in H.
std::vector<Vector3f> flesh_H(const Figure& figure, const Finger& finger) {
  std::vector<Vector3f> flesh;
  for (const FigurePart& part : figure.parts) {
    for (std::size_t v = 0; v < part.positions_m.size(); ++v) {
      for (std::size_t k = 0; k < 4; ++k) {
        if (part.joints[v][k] == finger.joint[2] && part.weights[v][k] > 0.5F) flesh.push_back(part.positions_m[v]);
      }
    }
  }
  return flesh;
}

constexpr std::array<std::size_t, 3> gripping{thumb, index_finger, middle_finger};

// What the grip search varies.
struct GripState {
  HandShape shape;
  Vector3f centre_W{0, 0, 0};          // of the disc at the height of the contact
  float pitch_rad = 0.75F;             // of the hand below the horizontal
  float roll_rad = 0.F;                // thumb's side up
  std::array<float, 3> azimuth_rad{};  // of the contacts, from the hand's forward direction towards the little finger
};

constexpr int grip_unknowns = 19;
using GripVector = Eigen::Matrix<float, grip_unknowns, 1>;

GripVector pack(const GripState& s) {
  GripVector x;
  const auto& f = s.shape.fingers;
  x << s.shape.thumb_turn_W, f[thumb].flex_rad[1], f[thumb].flex_rad[2], f[index_finger].flex_rad[0],
      f[index_finger].flex_rad[1], f[index_finger].spread_rad, f[middle_finger].flex_rad[0],
      f[middle_finger].flex_rad[1], f[middle_finger].spread_rad, s.centre_W * 10, s.pitch_rad, s.roll_rad,
      s.azimuth_rad[0], s.azimuth_rad[1], s.azimuth_rad[2];
  return x;
}

GripState unpack(const GripVector& x, const HandShape& rest) {
  GripState s;
  s.shape = rest;
  s.shape.thumb_turn_W = x.head<3>();
  auto& f = s.shape.fingers;
  f[thumb].flex_rad = {0, x[3], x[4]};
  for (const std::size_t k : {0, 1}) {
    FingerBend& bend = f[k == 0 ? index_finger : middle_finger];
    const auto at = static_cast<Eigen::Index>(5 + 3 * k);
    bend.flex_rad = {x[at], x[at + 1], 0.55F * x[at + 1]};  // the last joint follows the one before it
    bend.spread_rad = x[at + 2];
  }
  s.centre_W = x.segment<3>(11) / 10;
  s.pitch_rad = x[14];
  s.roll_rad = x[15];
  s.azimuth_rad = {x[16], x[17], x[18]};
  return s;
}

// Axes of the board in the hand: forward, towards the little finger, up.
Matrix3f board_axes_W(const HandParts& hand, float pitch, float roll) {
  const float s = hand.thumb_side;
  const Matrix3f R =
      (AngleAxisf(pitch, Vector3f::UnitY()) * AngleAxisf(roll * s, Vector3f::UnitX())).toRotationMatrix();
  // R takes W to axes with x forward and z up; its rows are those axes written in W.
  Matrix3f A;
  A << R.transpose() * Vector3f::UnitX(), R.transpose() * Vector3f(0, -s, 0), R.transpose() * Vector3f::UnitZ();
  return A;
}

struct GripTask {
  const Figure& figure;
  const HandParts& hand;
  HandShape rest;
  float radius_m;
  float opening_m = 0;             // the pads stand off the rim by so much
  std::array<float, 3> flesh_m{};  // and each by so much more: the flesh is not a point
  GripVector prior;
  GripVector prior_weight;

  std::vector<float> residuals(const GripVector& x) const {
    const GripState s = unpack(x, rest);
    const Matrix3f A = board_axes_W(hand, s.pitch_rad, s.roll_rad);
    std::vector<float> r;
    r.reserve(40);
    for (std::size_t k = 0; k < 3; ++k) {
      const Fingertip tip = fingertip_W(figure, hand, s.shape, gripping[k]);
      const Vector3f out = A.col(0) * std::cos(s.azimuth_rad[k]) + A.col(1) * std::sin(s.azimuth_rad[k]);
      const Vector3f miss = tip.pad - (s.centre_W + out * (radius_m + opening_m + flesh_m[k]));
      for (int i = 0; i < 3; ++i) r.push_back(miss[i] * 1000.F);
      const Vector3f facing = tip.pad_normal + out;  // zero when the pad looks at the disc
      for (int i = 0; i < 3; ++i) r.push_back(facing[i] * 0.35F);
    }
    for (Eigen::Index i = 0; i < grip_unknowns; ++i) r.push_back((x[i] - prior[i]) * prior_weight[i]);
    return r;
  }

  GripVector solve(GripVector x) const {
    constexpr float h = 1e-3F;
    float damping = 1e-2F;
    std::vector<float> r = residuals(x);
    const auto cost = [](const std::vector<float>& v) {
      float sum = 0;
      for (const float one : v) sum += one * one;
      return sum;
    };
    for (int round = 0; round < 60; ++round) {
      const auto rows = static_cast<Eigen::Index>(r.size());
      Eigen::MatrixXf J(rows, grip_unknowns);
      for (Eigen::Index c = 0; c < grip_unknowns; ++c) {
        GripVector shifted = x;
        shifted[c] += h;
        const std::vector<float> there = residuals(shifted);
        for (Eigen::Index i = 0; i < rows; ++i) {
          J(i, c) = (there[static_cast<std::size_t>(i)] - r[static_cast<std::size_t>(i)]) / h;
        }
      }
      const Eigen::VectorXf e = Eigen::Map<const Eigen::VectorXf>(r.data(), rows);
      Eigen::MatrixXf N = J.transpose() * J;
      N.diagonal().array() += damping;
      const GripVector step = N.ldlt().solve(-J.transpose() * e);
      const GripVector next = x + step;
      const std::vector<float> there = residuals(next);
      if (cost(there) < cost(r)) {
        x = next;
        r = there;
        damping = std::max(1e-6F, damping * 0.4F);
        if (step.norm() < 1e-5F) break;
      } else {
        damping *= 5;
        if (damping > 1e6F) break;
      }
    }
    return x;
  }
};

GripState first_guess() {
  GripState s;
  s.shape = hand_shape("grip");
  s.centre_W = {0.13F, 0.01F, -0.06F};
  s.pitch_rad = radians(42);
  s.roll_rad = radians(12);
  s.azimuth_rad = {radians(192), radians(-10), radians(34)};
  return s;
}

// How the flesh of the gripping fingers lies to the disc.
struct GripFit {
  float contact_m = 0;                // height of the pads' middles over the disc's foot
  std::array<float, 3> distance_m{};  // of each fingertip from the disc; negative: inside it
};

GripFit fit_of(const GripTask& task, const GripState& s, const std::array<std::vector<Vector3f>, 3>& flesh,
               float height_m) {
  const Matrix3f A = board_axes_W(task.hand, s.pitch_rad, s.roll_rad);
  const Matrix3f R_WH = task.hand.R_HW.transpose();
  std::array<std::vector<Vector3f>, 3> places;  // in the disc's axes, from its middle at the height of the pads
  float lowest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Isometry3f X = last_bone(task.figure, task.hand, s.shape, gripping[k]);
    for (const Vector3f& p : flesh[k]) {
      places[k].push_back(A.transpose() * (R_WH * (X * p) - s.centre_W));
      lowest = std::min(lowest, places[k].back().z());
    }
  }
  GripFit fit;
  // The pads touch a little above the middle of the rim; higher where the tips would reach the board.
  fit.contact_m = std::clamp(0.001F - lowest, std::min(0.75F * height_m, height_m - 0.002F), height_m + 0.002F);
  for (std::size_t k = 0; k < 3; ++k) {
    fit.distance_m[k] = flesh[k].empty() ? 0.F : 1.F;
    for (const Vector3f& p : places[k]) {
      const float out = p.head<2>().norm() - task.radius_m;
      const float z = p.z() + fit.contact_m;
      const float up = std::max(-z, z - height_m);
      const float distance = out > 0 && up > 0 ? std::hypot(out, up) : std::max(out, up);
      fit.distance_m[k] = std::min(fit.distance_m[k], distance);
    }
  }
  return fit;
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
  const Eigen::Isometry3f X = last_bone(figure, hand, shape, f);
  const Matrix3f R_WH = hand.R_HW.transpose();
  return {R_WH * (X * finger.pad_H), R_WH * (X.linear() * finger.pad_normal_H), R_WH * (X * finger.tip_H)};
}

Grip grip_on_disc(const Figure& figure, const HandParts& hand, float radius_m, float height_m) {
  GripState guess = first_guess();
  guess.centre_W.y() *= hand.thumb_side;
  GripTask task{figure, hand, guess.shape, radius_m, 0.F, {}, pack(guess), GripVector::Zero()};
  // Angles may leave the prior by some 0.3 rad at the price of a millimetre; the disc's place is free.
  task.prior_weight.setConstant(1.2F);
  task.prior_weight.segment<3>(11).setConstant(1e-3F);
  task.prior_weight[14] = task.prior_weight[15] = 2.F;
  std::array<std::vector<Vector3f>, 3> flesh;
  for (std::size_t k = 0; k < 3; ++k) flesh[k] = flesh_H(figure, hand.fingers[gripping[k]]);
  GripVector closed = task.solve(pack(guess));
  GripFit fit = fit_of(task, unpack(closed, task.rest), flesh, height_m);
  for (int round = 0; round < 4; ++round) {
    for (std::size_t k = 0; k < 3; ++k) {
      task.flesh_m[k] = std::clamp(task.flesh_m[k] - fit.distance_m[k], -0.005F, 0.008F);
    }
    closed = task.solve(closed);
    fit = fit_of(task, unpack(closed, task.rest), flesh, height_m);
  }

  GripTask opened = task;
  opened.opening_m = 0.013F;
  opened.prior = closed;
  opened.prior_weight.setConstant(0.3F);
  opened.prior_weight.segment<3>(11).setConstant(1e4F);  // the disc stays where it is in the hand
  opened.prior_weight.segment<2>(14).setConstant(1e4F);

  const GripState state = unpack(closed, task.rest);
  const Matrix3f A = board_axes_W(hand, state.pitch_rad, state.roll_rad);
  Grip grip;
  grip.closed = state.shape;
  grip.open = unpack(opened.solve(closed), task.rest).shape;
  Matrix3f R_WP;
  R_WP << A.col(0), A.col(2).cross(A.col(0)), A.col(2);
  grip.X_WP.linear() = R_WP;
  grip.X_WP.translation() = state.centre_W - A.col(2) * fit.contact_m;
  for (const float distance : fit.distance_m) grip.residual_mm = std::max(grip.residual_mm, 1000 * std::abs(distance));
  return grip;
}

}  // namespace counterpart
