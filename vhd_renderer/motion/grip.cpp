#include "vhd_renderer/motion/grip.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr std::array<std::size_t, 3> gripping{thumb, index_finger, middle_finger};
constexpr std::array<float, 3> azimuth_rad{radians(172), radians(-32), radians(30)};  // wanted, of the contacts
constexpr float tip_over_board_m = 0.001F;
constexpr float opening_m = 0.008F;  // of each finger from the rim, before it closes

// What the search varies.
struct GripState {
  HandShape shape;
  Vector3f centre_W{0, 0, 0};  // of the disc at the height of the contact
  float pitch_rad = 0;         // of the hand below the horizontal
  float roll_rad = 0;          // thumb's side up
};

constexpr int unknowns = 20;
using GripVector = Eigen::Matrix<float, unknowns, 1>;

GripVector pack(const GripState& s) {
  GripVector x;
  const auto& f = s.shape.fingers;
  x << s.shape.thumb_turn_W, f[thumb].flex_rad[1], f[thumb].flex_rad[2], f[index_finger].flex_rad[0],
      f[index_finger].flex_rad[1], f[index_finger].spread_rad, f[middle_finger].flex_rad[0],
      f[middle_finger].flex_rad[1], f[middle_finger].spread_rad, s.centre_W * 10, s.pitch_rad, s.roll_rad,
      f[ring_finger].flex_rad[0], f[ring_finger].flex_rad[1], f[little_finger].flex_rad[0],
      f[little_finger].flex_rad[1];
  return x;
}

GripState unpack(const GripVector& x) {
  GripState s;
  s.shape.thumb_turn_W = x.head<3>();
  auto& f = s.shape.fingers;
  f[thumb].flex_rad = {0, x[3], x[4]};
  // The last joint follows the one before it; less in a finger whose tip presses on something.
  const auto bend = [&](std::size_t finger, Eigen::Index first, float last) {
    f[finger].flex_rad = {x[first], x[first + 1], last * x[first + 1]};
  };
  bend(index_finger, 5, 0.45F);
  bend(middle_finger, 8, 0.45F);
  bend(ring_finger, 16, 0.6F);
  bend(little_finger, 18, 0.6F);
  f[index_finger].spread_rad = x[7];
  f[middle_finger].spread_rad = x[10];
  s.centre_W = x.segment<3>(11) / 10;
  s.pitch_rad = x[14];
  s.roll_rad = x[15];
  return s;
}

// From the wrist to the end of the stretched middle finger.
float length_of(const Figure& figure, const HandParts& hand) {
  const Finger& middle = hand.fingers[middle_finger];
  Vector3f at_joint = figure.joints[at(hand.wrist)].X_HJ.translation();
  float length = 0;
  for (const int j : middle.joint) {
    const Vector3f next = figure.joints[at(j)].X_HJ.translation();
    length += (next - at_joint).norm();
    at_joint = next;
  }
  return length + (middle.tip_H - at_joint).norm();
}

GripState first_guess(const Figure& figure, const HandParts& hand) {
  GripState s;
  s.shape = hand_shape("grip");
  s.centre_W = Vector3f(0.59F, 0.057F * hand.thumb_side, -0.31F) * length_of(figure, hand);
  s.pitch_rad = radians(34);
  s.roll_rad = radians(8);
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

// Signed distance of a point from an upright cylinder on z = 0.
float outside_cylinder(const Vector3f& p, float radius, float height) {
  const float out = p.head<2>().norm() - radius;
  const float up = std::max(-p.z(), p.z() - height);
  return out > 0 && up > 0 ? std::hypot(out, up) : std::max(out, up);
}

// How the skin of a finger lies on the board; the disc stands at the origin.
struct SkinFit {
  float from_disc_m = 1;        // negative: inside
  float from_neighbours_m = 1;  // tall ones: kings
  float lowest_m = 1;
  float farthest_m = 0;  // from the middle of the disc, of what is lower than a king
};

struct GripSearch {
  const Figure& figure;
  const HandParts& hand;
  const HandSkin& skin;
  GripTarget target;
  float contact_m = 0;             // height of the pads' middles over the disc's foot
  float stand_off_m = 0;           // of the pads from the rim
  std::array<float, 3> flesh_m{};  // and each by so much more: the flesh is not a point
  GripVector prior = GripVector::Zero();
  GripVector prior_weight = GripVector::Zero();

  std::array<SkinFit, 5> fit(const GripState& s) const {
    const Matrix3f R_BW = board_axes_W(hand, s.pitch_rad, s.roll_rad).transpose();
    const Vector3f up(0, 0, contact_m);
    const auto places = skin.places_W(s.shape);
    std::array<SkinFit, 5> fits;
    for (std::size_t f = 0; f < 5; ++f) {
      for (const Vector3f& p_W : places[f]) {
        const Vector3f p = R_BW * (p_W - s.centre_W) + up;
        fits[f].lowest_m = std::min(fits[f].lowest_m, p.z());
        if (p.z() > 4 * target.height_m) continue;
        if (p.z() < 2 * target.height_m) fits[f].farthest_m = std::max(fits[f].farthest_m, p.head<2>().norm());
        fits[f].from_disc_m = std::min(fits[f].from_disc_m, outside_cylinder(p, target.radius_m, target.height_m));
        const Vector3f to_nearest(std::abs(p.x()) - target.square_m, std::abs(p.y()) - target.square_m, p.z());
        fits[f].from_neighbours_m =
            std::min(fits[f].from_neighbours_m, outside_cylinder(to_nearest, target.radius_m, 2 * target.height_m));
      }
    }
    return fits;
  }

  // Millimetres, and angles weighed so that a radian counts as some.
  std::vector<float> residuals(const GripVector& x) const {
    const GripState s = unpack(x);
    const Matrix3f A = board_axes_W(hand, s.pitch_rad, s.roll_rad);
    std::vector<float> r;
    r.reserve(64);
    for (std::size_t k = 0; k < 3; ++k) {
      const Fingertip tip = fingertip_W(figure, hand, s.shape, gripping[k]);
      const Vector3f radial = A.col(0) * std::cos(azimuth_rad[k]) + A.col(1) * std::sin(azimuth_rad[k]);
      const Vector3f miss = tip.pad - s.centre_W - radial * (target.radius_m + stand_off_m + flesh_m[k]);
      r.push_back(1000 * miss.dot(radial));
      r.push_back(300 * miss.dot(A.col(2).cross(radial)));
      r.push_back(400 * miss.dot(A.col(2)));
      r.push_back(0.8F * (tip.pad_normal + radial).dot(A.col(2).cross(radial)));  // the pad looks at the disc
    }
    const std::array<SkinFit, 5> fits = fit(s);
    const auto at_least = [&](float value, float least) { r.push_back(1000 * std::max(0.F, least - value)); };
    for (const std::size_t f : gripping) at_least(fits[f].lowest_m, tip_over_board_m);
    for (const std::size_t f : {ring_finger, little_finger}) at_least(fits[f].lowest_m, 2.5F * target.height_m);
    for (const SkinFit& one : fits) at_least(one.from_neighbours_m, 0.0015F);
    // However the hand is turned there are no neighbours in this circle; a hand that keeps to it fits everywhere.
    const float free_m = std::sqrt(2.F) * target.square_m - target.radius_m;
    for (const SkinFit& one : fits) r.push_back(250 * std::max(0.F, one.farthest_m - free_m));
    const auto within = [&](float angle, float least, float most) {
      r.push_back(60 * (std::max(0.F, least - angle) + std::max(0.F, angle - most)));
    };
    for (const Eigen::Index i : {3, 4}) within(x[i], radians(-10), radians(60));         // thumb
    for (const Eigen::Index i : {5, 8, 16, 18}) within(x[i], radians(-5), radians(85));  // at the knuckles
    for (const Eigen::Index i : {6, 9, 17, 19}) within(x[i], radians(5), radians(95));
    for (const Eigen::Index i : {7, 10}) within(x[i], radians(-14), radians(14));  // spread
    within(x.head<3>().norm(), 0, radians(50));
    within(s.pitch_rad, radians(30), radians(70));
    for (Eigen::Index i = 0; i < unknowns; ++i) r.push_back((x[i] - prior[i]) * prior_weight[i]);
    return r;
  }

  GripVector solve(GripVector x) const {
    constexpr float h = 1e-3F;
    constexpr int most_rounds = 40;
    float damping = 1e-2F;
    std::vector<float> r = residuals(x);
    const auto cost = [](const std::vector<float>& v) {
      float sum = 0;
      for (const float one : v) sum += one * one;
      return sum;
    };
    constexpr float enough = 1e-4F;  // of the cost: a step that gains less is the last one
    bool arrived = false;
    for (int round = 0; round < most_rounds && damping < 1e6F && !arrived; ++round) {
      const auto rows = static_cast<Eigen::Index>(r.size());
      const Eigen::VectorXf e = Eigen::Map<const Eigen::VectorXf>(r.data(), rows);
      Eigen::MatrixXf J(rows, unknowns);
      for (Eigen::Index c = 0; c < unknowns; ++c) {
        GripVector shifted = x;
        shifted[c] += h;
        const std::vector<float> there = residuals(shifted);
        J.col(c) = (Eigen::Map<const Eigen::VectorXf>(there.data(), rows) - e) / h;
      }
      Eigen::MatrixXf N = J.transpose() * J;
      const Eigen::VectorXf downhill = -J.transpose() * e;
      // The same slope serves until a step is found that goes down.
      for (; damping < 1e6F; damping *= 5) {
        Eigen::MatrixXf damped = N;
        damped.diagonal().array() += damping;
        const GripVector next = x + GripVector(damped.ldlt().solve(downhill));
        std::vector<float> there = residuals(next);
        const float gained = cost(r) - cost(there);
        if (gained <= 0) continue;
        x = next;
        arrived = gained < enough * cost(r);
        r = std::move(there);
        damping = std::max(1e-6F, damping * 0.3F);
        break;
      }
    }
    return x;
  }
};

}  // namespace

Grip grip_on_piece(const Figure& figure, const HandParts& hand, const GripTarget& target) {
  const HandSkin skin(figure, hand);
  GripSearch search{figure, hand, skin, target};
  // A little above the middle of the rim, so that the tips stay off the board.
  search.contact_m = std::min(0.8F * target.height_m, target.height_m - 0.0015F);
  // Angles may leave the first guess by some 0.3 rad at the price of a millimetre; the disc's place is free.
  search.prior_weight.setConstant(1.5F);
  search.prior_weight.segment<3>(11).setConstant(1e-3F);
  search.prior_weight.segment<2>(14).setConstant(2.5F);
  search.prior_weight.segment<6>(5).setConstant(2.F);
  search.prior = pack(first_guess(figure, hand));
  GripVector closed = search.solve(search.prior);
  for (int round = 0; round < 8; ++round) {
    const std::array<SkinFit, 5> fits = search.fit(unpack(closed));
    for (std::size_t k = 0; k < 3; ++k) {
      search.flesh_m[k] = std::clamp(search.flesh_m[k] - fits[gripping[k]].from_disc_m, -0.01F, 0.016F);
    }
    closed = search.solve(closed);
  }

  GripSearch opening = search;
  opening.stand_off_m = opening_m;
  opening.prior = closed;
  opening.prior_weight.setConstant(0.5F);
  opening.prior_weight.segment<5>(11).setConstant(1e4F);  // disc and hand stay where they are

  const GripState state = unpack(closed);
  const Matrix3f A = board_axes_W(hand, state.pitch_rad, state.roll_rad);
  Grip grip;
  grip.closed = state.shape;
  grip.open = unpack(opening.solve(closed)).shape;
  Matrix3f R_WP;
  R_WP << A.col(0), A.col(2).cross(A.col(0)), A.col(2);
  grip.X_WP.linear() = R_WP;
  grip.X_WP.translation() = state.centre_W - A.col(2) * search.contact_m;
  const std::array<SkinFit, 5> fits = search.fit(state);
  for (const std::size_t f : gripping) {
    grip.residual_mm = std::max(grip.residual_mm, 1000 * std::abs(fits[f].from_disc_m));
  }
  grip.open_skin_P = open_skin_P(figure, hand, grip);
  return grip;
}

std::vector<Vector3f> open_skin_P(const Figure& figure, const HandParts& hand, const Grip& grip) {
  const Eigen::Isometry3f X_PW = grip.X_WP.inverse();
  std::vector<Vector3f> places_P;
  for (const auto& part : HandSkin(figure, hand).places_W(grip.open)) {
    for (const Vector3f& p_W : part) places_P.push_back(X_PW * p_W);
  }
  return places_P;
}

}  // namespace counterpart
