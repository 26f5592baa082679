#include "stage/player/seated_body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/vocabulary/scene.hpp"
#include "stage/player/gesture.hpp"
#include "stage/room/arm.hpp"
#include "vhd_renderer/body/build_character.hpp"
#include "vhd_renderer/motion/actor.hpp"
#include "vhd_renderer/motion/director.hpp"
#include "vhd_renderer/motion/grip.hpp"

namespace counterpart::stage {
namespace {

using Eigen::Isometry3d;
using Eigen::Isometry3f;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kHandAtRest_m = 0.01;  // nearer than this to where it rests, the hand has nothing to do
constexpr double kClose_s = 0.12;       // fingers round a piece

// He sits as the dark side does: S is R turned by half a circle.
Isometry3f half_circle() {
  return Isometry3f(Eigen::AngleAxisf(std::numbers::pi_v<float>, Vector3f::UnitZ()));
}

// The board and his edge of the table.
Scene scene_of(const BoardGeometry& board) {
  Scene scene;
  scene.board = board;
  scene.table_height_m = -kFloorZ_m;
  scene.virtual_side = Side::dark;
  SceneBox table;
  table.name = "table";
  table.size_m = {kTableX_m, kTableNearY_m - kTableFarY_m, kTableThickness_m};
  table.X_BO.p = {0, (kTableNearY_m + kTableFarY_m) / 2, -board.thickness_m - kTableThickness_m / 2};
  scene.boxes = {table};
  return scene;
}

}  // namespace

struct SeatedBody::State {
  Figure figure;
  Anatomy anatomy;
  std::vector<Capsule> capsules_J;
  std::vector<std::string> morph_names;
  std::unique_ptr<Actor> actor;
  Grip grip;
  double time_s = 0;
  double closed = 0;  // 0..1
  bool begun = false;

  ArmGoal hand_goal(const World& world) const;
  std::shared_ptr<const SeatedPose> pose() const;
};

SeatedBody::SeatedBody(std::unique_ptr<State> state) : state_(std::move(state)) {}
SeatedBody::~SeatedBody() = default;

const Figure& SeatedBody::figure() const {
  return state_->figure;
}

const std::vector<std::string>& SeatedBody::morph_names() const {
  return state_->morph_names;
}

Result<std::unique_ptr<SeatedBody>> SeatedBody::seat(const std::string& figure, const BoardGeometry& board) {
  auto state = std::make_unique<State>();
  Result<Figure> made = figure_of(figure);
  if (!made) return failure(made.error().code, "The player's figure: " + made.error().message);
  state->figure = *std::move(made);
  Result<Anatomy> anatomy = anatomy_of(state->figure);
  if (!anatomy) return failure(anatomy.error().code, "The player's figure " + figure + ": " + anatomy.error().message);
  state->anatomy = *std::move(anatomy);
  state->capsules_J = limb_capsules(state->figure);
  state->morph_names = morph_names_of(state->figure);
  state->grip = grip_on_piece(state->figure, state->anatomy.arms[right_side].hand,
                              {static_cast<float>(board.piece_radius_m), static_cast<float>(board.piece_height_m),
                               static_cast<float>(board.square_size_m)});
  state->actor = std::make_unique<Actor>(state->figure, state->anatomy, 5);
  state->actor->set_scene(scene_of(board));
  return std::unique_ptr<SeatedBody>(new SeatedBody(std::move(state)));
}

ArmGoal SeatedBody::State::hand_goal(const World& world) const {
  // The piece that he holds, or would hold: foot in B, x the way the hand points.
  const Vector3d foot_B = world.hand.pinch_B - Vector3d(0, 0, grip_height_m(world.board));
  const Vector3d x_B = arm_for(world.hand.pinch_B).X_BHand.linear().col(0);
  Isometry3d X_BP = Isometry3d::Identity();
  X_BP.translation() = foot_B;
  X_BP.linear() = Eigen::AngleAxisd(std::atan2(x_B.y(), x_B.x()), Vector3d::UnitZ()).toRotationMatrix();
  const Isometry3f X_SW = half_circle() * (world.X_RB * X_BP).cast<float>() * grip.X_WP.inverse();
  ArmGoal goal;
  goal.wrist_S = X_SW.translation();
  goal.R_SW = Eigen::Quaternionf(X_SW.linear());
  goal.shape = blend(grip.open, grip.closed, static_cast<float>(closed));
  return goal;
}

std::shared_ptr<const SeatedPose> SeatedBody::State::pose() const {
  auto result = std::make_shared<SeatedPose>();
  const BodyPose& body = actor->solved().pose;
  const Isometry3f X_RS = half_circle();
  for (std::size_t j = 0; j < figure.joints.size(); ++j) {
    result->X_RJ.push_back(X_RS * joint_frame_S(figure, body, j));
    const Capsule& c = capsules_J[j];
    if (c.radius_a_m > 0) result->shape_R.push_back(moved(c, result->X_RJ.back()));
  }
  const auto& morphs = actor->controls().morphs;
  for (const std::string& name : morph_names) {
    const auto at = morphs.find(name);
    result->face.push_back(at == morphs.end() ? 0.F : at->second);
  }
  result->X_RChair = X_RS * Isometry3f(Eigen::Translation3f(0, actor->controls().chair_y, actor->home().floor_z));
  return result;
}

void SeatedBody::pass(double t_s, World& world) {
  State& s = *state_;
  if (s.begun && t_s <= s.time_s) return;
  const double dt_s = s.begun ? t_s - s.time_s : 0;
  if (!s.begun) s.actor->appear(s.actor->home().chair, Posture::seated, t_s);
  s.begun = true;
  s.time_s = t_s;
  const double step = dt_s / kClose_s;
  s.closed = std::clamp(s.closed + (world.hand.held_piece >= 0 ? step : -step), 0.0, 1.0);
  s.actor->begin(t_s);
  ActorInputs inputs;
  inputs.now_s = t_s;
  inputs.dt_s = static_cast<float>(dt_s);
  inputs.player_S = {0, 0.8F, 0.35F};  // where the other one sits
  if ((world.hand.pinch_B - resting_hand(world.board)).norm() > kHandAtRest_m) {
    inputs.arms[right_side] = {1, s.hand_goal(world)};
    inputs.gaze_S = half_circle() * (world.X_RB * world.hand.pinch_B).cast<float>();
    inputs.gaze_given = true;
  }
  s.actor->finish(inputs);
  world.seated = s.pose();
}

std::vector<Capsule> limb_capsules(const Figure& figure) {
  std::vector<Eigen::AlignedBox3f> boxes(figure.joints.size());
  std::vector<int> counts(figure.joints.size(), 0);
  for (const FigurePart& part : figure.parts) {
    for (std::size_t v = 0; v < part.positions_m.size(); ++v) {
      const auto most = std::max_element(part.weights[v].begin(), part.weights[v].end()) - part.weights[v].begin();
      const std::size_t joint = part.joints[v][static_cast<std::size_t>(most)];
      boxes[joint].extend(figure.joints[joint].X_HJ.inverse() * part.positions_m[v]);
      ++counts[joint];
    }
  }
  constexpr int kFewest = 12;
  std::vector<Capsule> capsules;
  for (std::size_t j = 0; j < boxes.size(); ++j) {
    Capsule capsule{Vector3f::Zero(), Vector3f::Zero(), 0, 0};
    if (counts[j] >= kFewest) {
      const Vector3f half = boxes[j].sizes() / 2;
      Eigen::Index longest = 0;
      half.maxCoeff(&longest);
      const float radius = (half.sum() - half[longest]) / 2;
      const Vector3f along = Vector3f::Unit(longest) * std::max(0.F, half[longest] - radius);
      capsule = {boxes[j].center() - along, boxes[j].center() + along, radius, radius};
    }
    capsules.push_back(capsule);
  }
  return capsules;
}

}  // namespace counterpart::stage
