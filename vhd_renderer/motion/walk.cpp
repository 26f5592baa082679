#include "vhd_renderer/motion/walk.hpp"

#include <cmath>

#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float metres_per_radian = 0.42F;  // how much walking a turn on the spot is worth
constexpr float late_lift = 0.56F;          // of a step: how far the pelvis has passed a foot when it lifts

constexpr float heel_off = radians(15);  // of a foot that still bears: the more, the more its sole has to slide

float heading_of(const Vector2f& d) {
  return std::atan2(-d.x(), d.y());
}

Vector2f direction(float heading) {
  return {-std::sin(heading), std::cos(heading)};
}

Vector2f to_right(float heading) {
  return {std::cos(heading), std::sin(heading)};
}

// The polyline with its corners cut by a quarter of the shorter side.
std::vector<Vector2f> rounded(const std::vector<Vector2f>& points) {
  std::vector<Vector2f> smooth = points;
  for (int round = 0; round < 3 && smooth.size() > 2; ++round) {
    std::vector<Vector2f> next{smooth.front()};
    for (std::size_t i = 0; i + 1 < smooth.size(); ++i) {
      const Vector2f& a = smooth[i];
      const Vector2f& b = smooth[i + 1];
      if (i > 0) next.push_back(a + (b - a) * 0.25F);
      if (i + 2 < smooth.size()) next.push_back(a + (b - a) * 0.75F);
    }
    next.push_back(smooth.back());
    smooth = next;
  }
  return smooth;
}

}  // namespace

float wrap_angle(float angle) {
  return std::remainder(angle, 2 * pi_f);
}

float standing_hip_height(const Anatomy& anatomy) {
  const Limb& leg = anatomy.legs[0].limb;
  return anatomy.legs[0].ankle_height_m + 0.985F * leg.length_m();
}

FootGoal standing_foot(const Place& place, std::size_t side, const Anatomy& anatomy, float half_width_m) {
  const float s = side == right_side ? 1.F : -1.F;
  // The ball lies before the ankle, the ankle under the hip.
  const float forward = anatomy.legs[side].ball_H.y() - 0.03F;
  const Vector2f p =
      place.p_S + to_right(place.heading_rad) * (s * (half_width_m + 0.02F)) + direction(place.heading_rad) * forward;
  FootGoal foot;
  foot.ball_S = {p.x(), p.y(), 0};
  foot.heading_rad = place.heading_rad - s * radians(6);
  return foot;
}

Walk::Walk(const Place& start, const std::vector<Vector2f>& through, const Place& end, const WalkStyle& style,
           const Anatomy& anatomy)
    : style_(style) {
  const Limb& leg = anatomy.legs[0].limb;
  leg_m_ = leg.length_m();
  hip_height_m_ = standing_hip_height(anatomy) - 0.006F;
  ball_forward_m_ = anatomy.legs[0].ball_H.y() - 0.03F;
  style_.step_m *= leg_m_ / 0.8F;

  std::vector<Vector2f> corners{start.p_S};
  for (const Vector2f& p : through) {
    if ((p - corners.back()).norm() > 0.05F) corners.push_back(p);
  }
  if ((end.p_S - corners.back()).norm() > 0.03F) corners.push_back(end.p_S);
  const std::vector<Vector2f> line = rounded(corners);

  path_.push_back(start);
  distance_.push_back(0);
  const auto go = [&](const Vector2f& p, float heading) {
    const Place& last = path_.back();
    const float turn = std::abs(wrap_angle(heading - last.heading_rad));
    distance_.push_back(distance_.back() + std::hypot((p - last.p_S).norm(), turn * metres_per_radian));
    path_.push_back({p, last.heading_rad + wrap_angle(heading - last.heading_rad)});
  };
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vector2f d = line[i + 1] - line[i];
    const int parts = std::max(1, static_cast<int>(d.norm() / 0.05F));
    go(line[i], heading_of(d));  // turning on the spot at a corner, or the small turn of a rounded one
    for (int k = 1; k <= parts; ++k) {
      go(line[i] + d * (static_cast<float>(k) / static_cast<float>(parts)), heading_of(d));
    }
  }
  go(path_.back().p_S, end.heading_rad);
  length_ = distance_.back();
  if (length_ < 0.02F) return;

  // Footfalls at equal distances, alternating; both feet together at the start and at the end.
  const int steps = std::max(2, static_cast<int>(std::lround(length_ / style_.step_m)));
  const float step = length_ / static_cast<float>(steps);
  for (int i = -1; i <= steps + 1; ++i) {
    const std::size_t side = i % 2 == 0 ? right_side : left_side;
    Footfall fall;
    fall.at = std::clamp(static_cast<float>(i) * step, 0.F, length_);
    fall.place = along(fall.at);
    fall.land = fall.at - late_lift * step;
    fall.lift = fall.at + late_lift * step;
    if (i <= 0) {
      fall.land = -9;
      if (i == -1) fall.lift = 0.04F * step;
    }
    if (i >= steps) {
      fall.lift = length_ + 9;
      if (i == steps + 1) fall.land = length_ - 0.02F * step;
    }
    feet_[side].push_back(fall);
  }
  const float cruise = length_ / style_.speed_m_s;
  ramp_s_ = std::min(0.55F, 0.5F * cruise);
  duration_s_ = static_cast<double>(cruise + ramp_s_);
}

Place Walk::along(float s) const {
  const auto above = std::lower_bound(distance_.begin(), distance_.end(), s);
  if (above == distance_.begin()) return path_.front();
  if (above == distance_.end()) return path_.back();
  const auto i = static_cast<std::size_t>(above - distance_.begin());
  const float span = distance_[i] - distance_[i - 1];
  const float t = span > 1e-6F ? (s - distance_[i - 1]) / span : 1.F;
  return {path_[i - 1].p_S + (path_[i].p_S - path_[i - 1].p_S) * t,
          lerp(path_[i - 1].heading_rad, path_[i].heading_rad, t)};
}

// Speeds up, goes on evenly, slows down; the speed itself has no corner.
float Walk::path_at(double t_s) const {
  const auto t = static_cast<float>(std::clamp(t_s, 0.0, duration_s_));
  const float total = static_cast<float>(duration_s_);
  const float speed = length_ / (total - ramp_s_);
  const auto ramped = [&](float x) {  // integral of a smooth step of length ramp_s_
    const float u = unit_clamp(x / ramp_s_);
    const float rising = ramp_s_ * (u * u * u - 0.5F * u * u * u * u);
    return rising + std::max(0.F, x - ramp_s_);
  };
  const float braking = ramped(std::max(0.F, t - (total - ramp_s_)));
  return std::min(length_, speed * (ramped(t) - braking));
}

FootGoal Walk::foot(std::size_t side, float s) const {
  const float sign = side == right_side ? 1.F : -1.F;
  const auto& falls = feet_[side];
  const auto goal_at = [&](const Footfall& fall) {
    const Vector2f p = fall.place.p_S + to_right(fall.place.heading_rad) * (sign * (style_.half_width_m + 0.02F)) +
                       direction(fall.place.heading_rad) * ball_forward_m_;
    FootGoal goal;
    goal.ball_S = {p.x(), p.y(), 0};
    goal.heading_rad = fall.place.heading_rad - sign * radians(6);
    return goal;
  };
  std::size_t i = 0;
  while (i + 1 < falls.size() && s >= falls[i + 1].land) ++i;
  FootGoal goal = goal_at(falls[i]);
  if (i + 1 >= falls.size() || s <= falls[i].lift) {
    // Heel off before the foot leaves, and down again from the heel after it has landed.
    if (falls[i].lift < length_ + 1) {
      const float reach = falls[i].lift - falls[i].at;
      const float late = unit_clamp((s - falls[i].at - 0.25F * reach) / (0.75F * reach));
      goal.pitch_rad = heel_off * late * late;
    }
    return goal;
  }
  const FootGoal next = goal_at(falls[i + 1]);
  const float stride = std::min(1.F, (next.ball_S - goal.ball_S).norm() / (1.6F * style_.step_m));
  const float u = (s - falls[i].lift) / (falls[i + 1].land - falls[i].lift);
  const float w = minimum_jerk(u);
  FootGoal swing;
  swing.ball_S = goal.ball_S + (next.ball_S - goal.ball_S) * w;
  swing.ball_S.z() = style_.lift_m * (0.35F + 0.65F * stride) * bump(u);
  swing.heading_rad = lerp(goal.heading_rad, next.heading_rad, w);
  swing.pitch_rad = heel_off * (1 - minimum_jerk(u * 1.4F)) + radians(18) * bump(u * 1.4F);
  return swing;
}

float Walk::pose(double t_s, BodyControls& c) const {
  if (length_ < 0.02F) return 0;
  const float s = path_at(t_s);
  const Place place = along(s);
  const float step = length_ / std::max(1.F, std::round(length_ / style_.step_m));
  c.heading_rad = place.heading_rad;
  for (const std::size_t side : {left_side, right_side}) c.feet[side] = foot(side, s);
  // The weight goes over to the foot that stands; at the ends it is in the middle.
  const float moving = minimum_jerk(std::min(s, length_ - s) / (0.7F * step));
  const float phase = pi_f * s / step;
  const Vector2f sway = to_right(place.heading_rad) * (0.022F * moving * std::cos(phase));
  c.pelvis_S.head<2>() = place.p_S + sway;
  // As high as the longer leg allows, so that no knee snaps straight.
  float height = hip_height_m_;
  for (const std::size_t side : {left_side, right_side}) {
    const FootGoal& f = c.feet[side];
    const float ankle_up = 0.08F + ball_forward_m_ * std::sin(f.pitch_rad) + f.ball_S.z();
    const Vector2f ankle = f.ball_S.head<2>() - direction(f.heading_rad) * (ball_forward_m_ * std::cos(f.pitch_rad));
    const float across =
        (ankle - c.pelvis_S.head<2>() - to_right(place.heading_rad) * (side == right_side ? 0.09F : -0.09F)).norm();
    const float reach = 0.985F * leg_m_;
    const float most = ankle_up + std::sqrt(std::max(0.04F, reach * reach - across * across));
    // Smooth minimum.
    const float d = height - most;
    height -= 0.5F * (d + std::sqrt(d * d + 0.0004F));
  }
  c.pelvis_S.z() = height;
  const float swing = moving * std::cos(phase);
  c.pelvis.yaw = -radians(5) * moving * std::sin(phase);
  c.pelvis.roll = -radians(2.5F) * swing;
  c.pelvis.pitch = radians(3) * moving;
  c.spine.yaw = radians(9) * moving * std::sin(phase);
  c.spine.roll = radians(2) * swing;
  c.spine.pitch = radians(2) * moving;
  return moving * std::sin(phase);
}

}  // namespace counterpart
