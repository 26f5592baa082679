#include "vhd_renderer/motion/stance.hpp"

#include <cmath>

#include "protocol/vocabulary/pose_eigen.hpp"
#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr double lower_s = 1.25;  // until he sits
constexpr double scoot_s = 1.35;  // until he sits at the board
constexpr float stance_half_m = 0.085F;

// A hand frame from where its fingers and its palm point.
Quaternionf hand_rotation(const Vector3f& fingers, const Vector3f& palm) {
  const Vector3f x = fingers.normalized();
  const Vector3f z = (-palm + x * x.dot(palm)).normalized();
  Eigen::Matrix3f R;
  R << x, z.cross(x), z;
  return Quaternionf(R);
}

// The hand lies on the table before the board, its palm down, pointing inwards.
Quaternionf resting_rotation(std::size_t side) {
  const float s = side == right_side ? 1.F : -1.F;
  return hand_rotation(Vector3f(-s * 0.92F, 0.38F, -0.06F), Vector3f(-s * 0.10F, 0, -1));
}

FootGoal seated_foot(const Home& home, std::size_t side, const Anatomy& anatomy) {
  FootGoal foot = standing_foot(home.seat_feet[side], side, anatomy, 0);
  foot.ball_S.z() = home.floor_z;
  return foot;
}

// Sitting down, from standing before the chair (0) over sitting on it (lower_s) to sitting at the board.
void sitting_moment(double t_s, const Home& home, const Anatomy& a, BodyControls& c, float& seatedness) {
  const auto t = static_cast<float>(t_s);
  const float down = minimum_jerk(t / static_cast<float>(lower_s));
  const float scoot = (t - static_cast<float>(lower_s)) / static_cast<float>(scoot_s);
  // Two pulls on the chair.
  const float in = 0.5F * (minimum_jerk(scoot * 2) + minimum_jerk(scoot * 2 - 1));
  const float stand_z = home.floor_z + standing_hip_height(a);
  const float back = minimum_jerk(t / (0.95F * static_cast<float>(lower_s)));
  c.heading_rad = 0;
  c.chair_y = lerp(home.chair_back_y, home.seat_y, in);
  c.pelvis_S = {0, lerp(lerp(home.chair.p_S.y(), home.chair_back_y, back), home.seat_y, in),
                lerp(stand_z, home.seat_hip_z, down)};
  const float leaning = bump(0.08F + 0.84F * t / static_cast<float>(lower_s)) - bump(0.08F);
  c.pelvis = {radians(22) * std::max(0.F, leaning) - radians(5) * down, 0, 0};
  c.spine = {radians(16) * std::max(0.F, leaning) + radians(7) * down, 0, 0};
  // Feet follow the chair in two steps each, one after the other.
  for (const std::size_t s : {left_side, right_side}) {
    FootGoal from = standing_foot(home.chair, s, a, stance_half_m);
    from.ball_S.z() = home.floor_z;
    const FootGoal to = seated_foot(home, s, a);
    const float lag = s == left_side ? 0.F : 0.22F;
    const float u1 = unit_clamp((scoot - lag + 0.05F) / 0.26F);
    const float u2 = unit_clamp((scoot - lag - 0.47F) / 0.28F);
    const float along = 0.5F * (minimum_jerk(u1) + minimum_jerk(u2));
    FootGoal& foot = c.feet[s];
    foot.ball_S = from.ball_S + (to.ball_S - from.ball_S) * along;
    foot.ball_S.z() += 0.03F * (bump(u1) + bump(u2));
    foot.heading_rad = lerp(from.heading_rad, to.heading_rad, along);
    foot.pitch_rad = radians(8) * (bump(u1) + bump(u2));
  }
  seatedness = minimum_jerk((t - static_cast<float>(lower_s) * 0.55F) / (0.45F * static_cast<float>(lower_s)) - 0.F);
}

// The side of the scene's table that is nearest to him, in S.
float table_edge_y(const Scene& scene, float otherwise) {
  for (const SceneBox& box : scene.boxes) {
    if (box.name != "table") continue;
    const Eigen::Isometry3f X_BO = to_eigen(box.X_BO).cast<float>();
    const Vector3f half = to_eigen(box.size_m).cast<float>() / 2;
    const float reach = X_BO.linear().row(1).cwiseAbs().dot(half);
    return (scene.virtual_side == Side::dark ? -1.F : 1.F) * X_BO.translation().y() - reach;
  }
  return otherwise;
}

}  // namespace

Home home_of(const Scene& scene, const Anatomy& a, const std::array<float, 2>& rest_depth_m) {
  Home home;
  const auto floor = static_cast<float>(-scene.table_height_m);
  const auto edge = static_cast<float>(0.5 * scene.board.squares * scene.board.square_size_m + scene.board.border_m);
  home.floor_z = floor;
  home.table_z = static_cast<float>(-scene.board.thickness_m);
  home.board_half_m = edge;
  home.table_edge_y = table_edge_y(scene, -edge - usual_table_beyond_board_m);
  home.seat_y = home.table_edge_y - 0.02F - a.belly_m;
  home.seat_hip_z = floor + chair_seat_m + a.seat_to_hip_m;
  home.chair = {{0, home.seat_y - 0.15F}, 0};
  home.chair_back_y = home.chair.p_S.y() - 0.26F;
  home.entrance = {{1.75F, home.chair.p_S.y() - 0.75F}, pi_f / 2};
  home.away = {{2.9F, home.chair.p_S.y() - 1.1F}, -pi_f / 2};
  for (const std::size_t s : {left_side, right_side}) {
    const float side = s == right_side ? 1.F : -1.F;
    // Before the board, between its rim and the table's edge, or a little beyond where there is no room.
    const float y = std::max(home.table_edge_y + 0.035F, -edge - 0.135F);
    home.rest_wrist[s] = {side * (s == right_side ? 0.235F : 0.215F), y, home.table_z + rest_depth_m[s] + 0.001F};
    // Shins a little forward of upright.
    const Limb& leg = a.legs[s].limb;
    home.seat_feet[s] = {{side * 0.115F, home.seat_y + leg.upper_m * 0.97F + (s == right_side ? 0.0F : 0.06F)}, 0};
  }
  return home;
}

Stretch Stretch::walk(Walk walk) {
  Stretch s;
  s.kind_ = Kind::walk;
  s.walk_ = std::move(walk);
  return s;
}

Stretch Stretch::sit_down(const Home&, const Anatomy&) {
  Stretch s;
  s.kind_ = Kind::sit;
  return s;
}

Stretch Stretch::get_up(const Home&, const Anatomy&) {
  Stretch s;
  s.kind_ = Kind::up;
  return s;
}

double Stretch::duration_s() const {
  return kind_ == Kind::walk ? walk_.duration_s() : lower_s + scoot_s;
}

const char* Stretch::phase() const {
  return kind_ == Kind::walk ? "walk" : kind_ == Kind::sit ? "sit" : "stand_up";
}

float Stretch::pose(double t_s, const Home& home, const Anatomy& anatomy, BodyControls& c, float& seatedness) const {
  if (kind_ != Kind::walk) {
    sitting_moment(kind_ == Kind::sit ? t_s : duration_s() - t_s, home, anatomy, c, seatedness);
    return 0;
  }
  seatedness = 0;
  const float swing = walk_.pose(t_s, c);
  c.pelvis_S.z() += home.floor_z;
  for (FootGoal& foot : c.feet) foot.ball_S.z() += home.floor_z;
  return swing;
}

void stand(const Place& place, const Home& home, const Anatomy& a, BodyControls& c) {
  c.heading_rad = place.heading_rad;
  c.pelvis_S = {place.p_S.x(), place.p_S.y(), home.floor_z + standing_hip_height(a)};
  c.pelvis = {};
  c.spine = {};
  for (const std::size_t s : {left_side, right_side}) {
    c.feet[s] = standing_foot(place, s, a, stance_half_m);
    c.feet[s].ball_S.z() = home.floor_z;
  }
}

void sit(const Home& home, const Anatomy& a, BodyControls& c) {
  float seatedness = 1;
  sitting_moment(lower_s + scoot_s, home, a, c, seatedness);
  // Up, as far as his legs let him with his feet where they are.
  constexpr float forward_m = 0.06F;
  const LegParts& leg = a.legs[0];
  const float ahead = home.seat_feet[left_side].p_S.y() - home.seat_y - forward_m;
  const float reach = 0.97F * leg.limb.length_m();
  const float legs_up = std::sqrt(std::max(0.F, reach * reach - ahead * ahead)) + leg.ankle_height_m;
  const float stands = lerp(home.seat_hip_z - home.floor_z, standing_hip_height(a), 0.95F);
  c.rise_S = {0, forward_m, std::max(0.F, std::min(legs_up, stands) - (home.seat_hip_z - home.floor_z))};
}

ArmGoal hanging_arm(const Anatomy& a, const BodyControls& c, std::size_t side, float swing) {
  const float s = side == right_side ? 1.F : -1.F;
  const Quaternionf G(AngleAxisf(c.heading_rad, Vector3f::UnitZ()));
  const float reach = a.arms[side].limb.length_m();
  const float angle = radians(10) + s * swing * radians(19);
  // About the shoulder, which hangs over the hips with the trunk's lean.
  const float trunk = 0.9F * a.hip_height_m * 0.56F;
  const Quaternionf lean = rotation_of(c.heading_rad, c.pelvis + c.spine * 0.6F);
  const Vector3f shoulder = c.pelvis_S + lean * Vector3f(s * 0.185F, 0.005F, trunk);
  ArmGoal goal;
  goal.wrist_S = shoulder + G * Vector3f(s * 0.075F, std::sin(angle) * reach * 0.93F, -std::cos(angle) * reach * 0.93F);
  const Vector3f fingers = G * Vector3f(s * -0.06F, std::sin(angle + 0.2F), -std::cos(angle + 0.2F));
  goal.R_SW = hand_rotation(fingers, G * Vector3f(-s, 0.15F, 0));
  goal.help = 0;
  goal.shape = hand_shape("relaxed");
  return goal;
}

ArmGoal resting_arm(const Home& home, std::size_t side) {
  ArmGoal goal;
  goal.wrist_S = home.rest_wrist[side];
  goal.R_SW = resting_rotation(side);
  goal.shape = hand_shape("rest");
  return goal;
}

float resting_depth_m(const Figure& figure, const HandParts& hand, std::size_t side) {
  float lowest = 0;
  const Quaternionf R_SW = resting_rotation(side);
  for (const auto& part : HandSkin(figure, hand).places_W(hand_shape("rest"))) {
    for (const Vector3f& p_W : part) lowest = std::min(lowest, (R_SW * p_W).z());
  }
  return -lowest;
}

}  // namespace counterpart
