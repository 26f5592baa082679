#include "stage/room/room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "stage/player/seated_body.hpp"
#include "stage/room/arm.hpp"
#include "stage/room/surfaces.hpp"
#include "stage/room/textures.hpp"
#include "stage/room/warp.hpp"
#include "vhd_renderer/body/simplify.hpp"
#include "vhd_renderer/draw/piece_shape.hpp"
#include "vhd_renderer/motion/director.hpp"
#include "vhd_renderer/scene/chair_shape.hpp"
#include "vhd_renderer/scene/figure_items.hpp"

namespace counterpart::stage {
namespace {

constexpr float kWallY_m = -2.3f;
constexpr float kSideWallX_m = 3.5f;
const Eigen::Vector3f kWallPaint(0.60f, 0.57f, 0.51f);  // encoded, as the wall's texture
constexpr std::size_t kArmParts = 4;
constexpr int kPainted = 6;  // the last things of the furniture: floor, walls, skirting boards

Eigen::Affine3f at(float x, float y, float z) {
  return Eigen::Affine3f(Eigen::Translation3f(x, y, z));
}

// The four upright sides of a box: its top and bottom are not seen.
MeshData skirt_mesh(const Eigen::Vector3f& size_m) {
  MeshData mesh = box_mesh(size_m);
  mesh.triangles.resize(4 * 6);
  return mesh;
}

// The upper face of a warped board.
MeshData top_mesh(float side_m, int cells, const Warp& warp) {
  MeshData mesh = plane_mesh(side_m, side_m, cells, cells);
  for (Eigen::Vector3f& p : mesh.positions_m) p.z() = static_cast<float>(warp.height_m(p.x(), p.y()));
  return mesh;
}

MeshData cup_mesh() {
  MeshData mesh = lathe_mesh({{0.030f, 0},
                              {0.040f, 0.03f},
                              {0.042f, 0.095f},
                              {0.042f, 0.095f},
                              {0.038f, 0.095f},
                              {0.038f, 0.095f},
                              {0.036f, 0.05f},
                              {0, 0.05f}},
                             28);
  constexpr int kBeads = 9;
  std::vector<Capsule> handle;
  const auto bead = [](int i) {
    const float angle = -1.45f + 2.9f * static_cast<float>(i) / kBeads;
    return Eigen::Vector3f(0.040f + 0.028f * std::cos(angle), 0, 0.05f + 0.028f * std::sin(angle));
  };
  for (int i = 0; i < kBeads; ++i) handle.push_back({bead(i), bead(i + 1), 0.0055f, 0.0055f});
  append(mesh, blended(handle, 0.004f, 0.003f), {0, 0, 0});
  return mesh;
}

// Where the things on the floor keep the light off it, from the floor's middle.
std::vector<FloorShade> floor_shades(const RoomOptions& options) {
  std::vector<FloorShade> shades;
  for (const ObjectPlan& plan : options.objects) {
    if (!plan.on_floor) continue;
    shades.push_back({plan.place_R_m - Eigen::Vector2d(0, kWallY_m + 2.5), plan.size_m.head<2>() / 2});
  }
  return shades;
}

// What lies outside the light that is computed is painted as bright as the room is.
float painted_light(const World& world) {
  return std::sqrt(0.04f + 0.96f * static_cast<float>(world.light));
}

}  // namespace

struct Circle {
  Eigen::Vector2f middle_B;
  float radius_m;
};

// Something that stands in the room, or lies on the board.
struct Furniture {
  DrawItem item;
  bool on_board = false;
  float shadow_reach_m = 0;  // of a part of the table: shadows farther off than this from its middle do not touch it
};

struct Room::State {
  RoomOptions options;
  std::unique_ptr<Renderer> renderer;
  std::vector<Furniture> furniture;
  SurfaceId painted{};
  DrawItem pieces, cup, coffee, sheet;
  DrawItem hand, wrist, forearm, upper_arm;
  Figure figure;  // of the whole player, as detailed as the picture can show
  std::vector<DrawItem> figure_parts;
  DrawItem chair;                      // the player's
  std::vector<DrawItem> objects;       // as in RoomOptions
  DrawItem piece_shadow, hand_shadow;  // coarser, and not seen themselves
  Warp warp;                           // of the board's top

  Lighting lighting(const World& world) const;
  std::vector<Circle> shadows_on_table(const World& world, const Lighting& light) const;
  std::vector<DrawItem> items(const World& world) const;
  void add_arm(const World& world, std::vector<DrawItem>& items) const;
  void add_body(const World& world, std::vector<DrawItem>& items) const;
  Result<void> build();
};

Room::Room(std::unique_ptr<State> state) : state_(std::move(state)) {}
Room::~Room() = default;

Result<std::unique_ptr<Room>> Room::furnish(const RoomOptions& options) {
  auto state = std::make_unique<State>();
  state->options = options;
  auto renderer = Renderer::create(options.width, options.height, 512);
  if (!renderer) return tl::make_unexpected(renderer.error());
  state->renderer = std::move(*renderer);
  if (const Result<void> built = state->build(); !built) return tl::make_unexpected(built.error());
  return std::unique_ptr<Room>(new Room(std::move(state)));
}

Result<void> Room::State::build() {
  const BoardGeometry& board = options.board;
  const std::uint64_t seed = options.seed;
  Renderer& r = *renderer;
  const auto field = static_cast<float>(board.squares * board.square_size_m);
  const float side = field + 2 * static_cast<float>(board.border_m);
  const auto thickness = static_cast<float>(board.thickness_m);
  warp = Warp(options.warp_m, 0.5 * board.squares * board.square_size_m + board.border_m, options.warp_seed);

  const auto surface = [&r](const std::string& glsl, Shade shade, SurfaceId& slot) -> Result<void> {
    const Result<SurfaceId> made = r.add_surface(glsl, shade);
    if (!made) return tl::make_unexpected(made.error());
    slot = *made;
    return {};
  };
  SurfaceId board_top{}, level{}, wooden{}, skin{};
  Result<void> made = surface(board_surface(), Shade::level, board_top);
  if (made) made = surface("", Shade::level, level);
  if (made) made = surface("", Shade::painted, painted);
  if (made) made = surface(wooden_piece_surface(), Shade::lit, wooden);
  if (made) made = surface(skin_surface(), Shade::lit, skin);
  if (!made) return made;
  r.set_parameters(board_top, {static_cast<float>(board.squares), static_cast<float>(board.square_size_m),
                               board.played_on == SquareColour::dark ? 0.5f : -0.5f, 0.f});

  const TextureId board_grain =
      r.add_texture(board_grain_texture(1024, board.squares, 2 * board.border_m / static_cast<double>(side), seed));
  const TextureId grain = r.add_texture(wood_texture(512, 512, {236, 236, 236}, {170, 170, 170}, seed));
  const TextureId table = r.add_texture(table_texture(1024, 512, seed + 1));
  const TextureId floor = r.add_texture(floor_texture(1024, 1024, seed + 2, floor_shades(options)));
  const TextureId wall = r.add_texture(wall_texture(1600, 800, seed + 3));
  const TextureId cloth = r.add_texture(cloth_texture(256, 256, seed + 4));
  const TextureId print = r.add_texture(newspaper_texture(512, 512, seed + 5));

  const auto add = [&](DrawItem& slot, const MeshData& mesh, const Material& material, const Eigen::Affine3f& X,
                       bool casts_shadow) {
    if (!made) return;
    const Result<MeshId> id = r.add_mesh(mesh);
    if (!id) {
      made = tl::make_unexpected(id.error());
      return;
    }
    slot = DrawItem{*id, material, {X}, casts_shadow, true};
  };
  const float table_y = kTableNearY_m - kTableFarY_m;
  const float table_middle = (kTableNearY_m + kTableFarY_m) / 2;
  const int finer = options.fine ? 3 : 1;
  const Eigen::Affine3f upright(Eigen::AngleAxisf(EIGEN_PI, Eigen::Vector3f::UnitZ()) *
                                Eigen::AngleAxisf(static_cast<float>(EIGEN_PI) / 2, Eigen::Vector3f::UnitX()));
  constexpr auto floor_z = static_cast<float>(kFloorZ_m);
  furniture.resize(9);
  add(furniture[0].item, top_mesh(side, 14 * finer, warp), {board_top, board_grain}, at(0, 0, 0), false);
  add(furniture[1].item, skirt_mesh({side, side, thickness}),
      {SurfaceId::lit, grain, {0.13f, 0.06f, 0.03f}, 0.1f, 30, false},
      at(0, 0, -thickness / 2 + 0.0002f + static_cast<float>(options.warp_m)),
      true);  // no gap under the top
  furniture[0].on_board = furniture[1].on_board = true;
  add(furniture[2].item, skirt_mesh({kTableX_m, table_y, kTableThickness_m}),
      {SurfaceId::lit, table, {0.8f, 0.75f, 0.7f}, 0.05f, 20, false},
      at(0, table_middle, -thickness - kTableThickness_m / 2 - 0.0005f), false);
  add(furniture[3].item, plane_mesh(7.f, 5.f, 10 * finer, 8 * finer), {painted, floor}, at(0, kWallY_m + 2.5f, floor_z),
      false);
  add(furniture[4].item, plane_mesh(7.f, 2.6f, 7 * finer, 3 * finer), {painted, wall},
      at(0, kWallY_m, floor_z + 1.3f) * upright, false);
  for (const std::size_t k : {0u, 1u}) {
    const float sign = k == 0 ? -1.f : 1.f;
    const Eigen::Affine3f turned(Eigen::AngleAxisf(sign * static_cast<float>(EIGEN_PI) / 2, Eigen::Vector3f::UnitZ()));
    const float y = kWallY_m + 2.5f;
    add(furniture[5 + k].item, plane_mesh(5.f, 2.6f, 5 * finer, 3 * finer), {painted, TextureId::white, kWallPaint},
        at(sign * kSideWallX_m, y, floor_z + 1.3f) * turned * upright, false);
    add(furniture[7 + k].item, plane_mesh(5.f, 0.09f, 5 * finer, 1), {painted, TextureId::white, 1.25f * kWallPaint},
        at(sign * (kSideWallX_m - 0.01f), y, floor_z + 0.045f) * turned * upright, false);
  }

  constexpr int kTilesX = 6;
  constexpr int kTilesY = 4;
  for (int row = 0; row < kTilesY; ++row) {
    for (int col = 0; col < kTilesX; ++col) {
      const Eigen::Vector2f size(kTableX_m / kTilesX, table_y / kTilesY);
      MeshData tile = plane_mesh(size.x(), size.y(), 2 * finer, 2 * finer);
      for (Eigen::Vector2f& uv : tile.uvs) {
        uv = {(uv.x() + static_cast<float>(col)) / kTilesX, (uv.y() + static_cast<float>(kTilesY - 1 - row)) / kTilesY};
      }
      Furniture piece;
      piece.shadow_reach_m = size.norm() / 2;
      add(piece.item, tile, {level, table},
          at((static_cast<float>(col) + 0.5f) * size.x() - kTableX_m / 2,
             (static_cast<float>(row) + 0.5f) * size.y() + kTableFarY_m, -thickness),
          false);
      furniture.insert(furniture.begin() + 2, piece);
    }
  }

  const auto radius = static_cast<float>(board.piece_radius_m);
  const Eigen::Vector3f shirt(0.09f, 0.15f, 0.26f);
  const Eigen::Affine3f here = Eigen::Affine3f::Identity();
  const auto height = static_cast<float>(board.piece_height_m);
  add(piece_shadow, lathe_mesh({{radius, 0}, {radius, height}, {0, height}}, 14), {}, here, true);
  add(hand_shadow, blended(hand_capsules(radius), kFingersMelt_m, 0.009f), {}, here, true);
  piece_shadow.visible = hand_shadow.visible = false;
  add(pieces, piece_shape(board, options.width > 800 ? 28 : 16),
      {wooden, grain, {0.085f, 0.032f, 0.016f}, 0.22f, 36, false}, here, false);
  add(hand, blended(hand_capsules(radius), kFingersMelt_m, options.width > 800 ? 0.0042f : 0.0075f),
      {skin, TextureId::white, {0.62f, 0.36f, 0.26f}, 0.10f, 14, false}, here, false);
  add(wrist, blended(wrist_capsules(), 0.01f, 0.010f),
      {skin, TextureId::white, {0.62f, 0.36f, 0.26f}, 0.10f, 14, false}, here, true);
  const Material cloth_material{SurfaceId::lit, cloth, shirt, 0.01f, 8, true};
  add(forearm, sleeve_mesh(static_cast<float>(kSleeve_m), kSleeveNear_m, kSleeveFar_m), cloth_material, here, true);
  add(upper_arm, sleeve_mesh(static_cast<float>(kUpperArm_m) + 0.03f, 0.066f, kSleeveNear_m), cloth_material, here,
      true);
  add(cup, cup_mesh(), {SurfaceId::lit, TextureId::white, {0.80f, 0.78f, 0.74f}, 0.35f, 60, false}, here, true);
  add(coffee, lathe_mesh({{0.0365f, 0.075f}, {0, 0.075f}}, 24),
      {SurfaceId::lit, TextureId::white, {0.05f, 0.025f, 0.012f}, 0.3f, 60, false}, here, false);
  const std::array<Eigen::Vector3f, 3> paints{{{0.42f, 0.29f, 0.17f}, {0.52f, 0.47f, 0.40f}, {0.24f, 0.11f, 0.055f}}};
  objects.resize(options.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const ObjectPlan& plan = options.objects[i];
    const auto paint = static_cast<std::size_t>(plan.kind) - 1;
    add(objects[i], mesh_of(polygon_model(plan.kind, plan.size_m), options.fine ? 0.03 : 0.5),
        {SurfaceId::lit, grain, paints.at(paint), 0.03f, 16, false}, here, !plan.on_floor);
  }
  if (options.body != nullptr) {
    figure = simplified(options.body->figure(), unseen_error_m(options.height));
    add(chair, chair_shape(), {SurfaceId::lit, grain, {0.16f, 0.075f, 0.035f}, 0.05f, 16, false}, here, false);
    Result<std::vector<DrawItem>> parts = figure_items(figure, r);
    if (!parts) return tl::make_unexpected(parts.error());
    figure_parts = *std::move(parts);
  }
  add(sheet, plane_mesh(1, 1, 8, 8), {SurfaceId::lit, print, {0.78f, 0.77f, 0.72f}, 0.01f, 8, true}, here, true);
  return made;
}

Lighting Room::State::lighting(const World& world) const {
  const auto level = static_cast<float>(world.light);
  Lighting light;
  light.direction_B = world.X_RB.linear().transpose().cast<float>() * options.light_direction_R;
  light.colour = Eigen::Vector3f(0.98f, 0.93f, 0.84f) * level;
  light.ambient_up = Eigen::Vector3f(0.36f, 0.37f, 0.40f) * (0.12f + 0.88f * level);
  light.ambient_down = Eigen::Vector3f(0.20f, 0.17f, 0.14f) * (0.12f + 0.88f * level);
  light.shadow_centre_B = {0, 0.1f, 0};
  light.shadow_radius_m = 0.55f;
  light.softness_m = 0.007f;
  if (world.seated) {
    light.shadow_centre_B = {0, 0.25f, 0.1f};
    light.shadow_radius_m = 0.85f;
  }
  return light;
}

// Circles on the table's plane that hold all shadows.
std::vector<Circle> Room::State::shadows_on_table(const World& world, const Lighting& light) const {
  const Eigen::Vector3f direction = light.direction_B.normalized();
  const auto table_z = static_cast<float>(-world.board.thickness_m);
  std::vector<Circle> result;
  const auto add = [&](const Eigen::Vector3d& middle, double radius_m) {
    const Eigen::Vector3f p = middle.cast<float>();
    const Eigen::Vector3f foot = p - direction * ((p.z() - table_z) / direction.z());
    result.push_back({foot.head<2>(), static_cast<float>(radius_m) / direction.z() + 2 * light.softness_m});
  };
  if (world.board_present) {
    const double board_half = 0.5 * world.board.squares * world.board.square_size_m + world.board.border_m;
    add({0, 0, table_z / 2}, 1.42 * board_half);
  }
  for (const RealPiece& piece : world.pieces) {
    if (piece.square == 0) add(piece.p_B, 2 * world.board.piece_radius_m);
  }
  if (world.player_present && world.seated) {
    const Eigen::Isometry3d X_BR = world.X_RB.inverse();
    for (const Capsule& c : world.seated->shape_R) {
      if (c.a_m.z() < table_z && c.b_m.z() < table_z) continue;  // his legs
      add(X_BR * ((c.a_m + c.b_m) / 2).cast<double>(), (c.b_m - c.a_m).norm() / 2 + 1.2F * c.radius_a_m);
    }
  } else if (world.player_present) {
    const ArmPose pose = arm_for(world.hand.pinch_B);
    add(pose.X_BHand * Eigen::Vector3d(0.06, 0, 0), 0.16);
    for (const double share : {0.25, 0.75}) {
      add(pose.X_BForearm * Eigen::Vector3d(0, 0, share * kForearm_m), 0.11);
      add(pose.X_BUpperArm * Eigen::Vector3d(0, 0, share * kUpperArm_m), 0.13);
    }
  }
  for (const RoomObject& object : world.objects) {
    add(world.X_RB.inverse() * object.X_RO.translation(), object.size_m.norm() / 2);
  }
  if (world.cup_R) add(world.X_RB.inverse() * (*world.cup_R + Eigen::Vector3d(0, 0, 0.05)), 0.09);
  if (world.sheet) add(world.sheet->X_BS.translation(), std::hypot(world.sheet->size_x_m, world.sheet->size_y_m) / 2);
  return result;
}

// What is seen of the player where it is his arm alone: kArmParts items, and a shadow.
void Room::State::add_arm(const World& world, std::vector<DrawItem>& items) const {
  const ArmPose pose = arm_for(world.hand.pinch_B);
  for (const auto& [item, X] : {std::pair{&hand, &pose.X_BHand},
                                {&wrist, &pose.X_BForearm},
                                {&forearm, &pose.X_BForearm},
                                {&upper_arm, &pose.X_BUpperArm}}) {
    items.push_back(*item);
    items.back().X_BO = {Eigen::Affine3f(X->cast<float>())};
  }
  items.push_back(hand_shadow);
  items.back().X_BO = {Eigen::Affine3f(pose.X_BHand.cast<float>())};
}

// The player in whole, his chair last.
void Room::State::add_body(const World& world, std::vector<DrawItem>& items) const {
  const Eigen::Isometry3f X_BR = world.X_RB.inverse().cast<float>();
  Performance pose;
  for (const Eigen::Isometry3f& X_RJ : world.seated->X_RJ) pose.X_BJ.push_back(X_BR * X_RJ);
  pose.morphs = world.seated->face;
  std::vector<SkinnedPart> skinned;
  skin(figure, options.body->morph_names(), pose, skinned);
  for (std::size_t i = 0; i < figure_parts.size(); ++i) {
    renderer->update_mesh(figure_parts[i].mesh, skinned[i].positions_m, skinned[i].normals);
    items.push_back(figure_parts[i]);
  }
  items.push_back(chair);
  items.back().X_BO = {Eigen::Affine3f(X_BR * world.seated->X_RChair)};
}

std::vector<DrawItem> Room::State::items(const World& world) const {
  std::vector<DrawItem> items;  // near things first
  if (world.player_present && world.seated && options.body != nullptr) {
    add_body(world, items);
  } else if (world.player_present) {
    add_arm(world, items);
  }
  DrawItem standing = pieces;
  standing.X_BO.clear();
  for (const RealPiece& piece : world.pieces) {
    Eigen::Affine3f X_BO(Eigen::Translation3f(piece.p_B.cast<float>()));
    if (piece.square != 0) X_BO.translation().z() += static_cast<float>(warp.height_m(piece.p_B.x(), piece.p_B.y()));
    X_BO.rotate(Eigen::AngleAxisf(static_cast<float>(piece.turn_rad), Eigen::Vector3f::UnitZ()));
    if (piece.roll_rad != 0) {
      const Eigen::Translation3f up(0, 0, static_cast<float>(world.board.piece_height_m) / 2);
      X_BO = X_BO * up * Eigen::AngleAxisf(static_cast<float>(piece.roll_rad), Eigen::Vector3f::UnitX()) * up.inverse();
    }
    standing.X_BO.push_back(X_BO);
    if (piece.king) {
      standing.X_BO.push_back(
          Eigen::Affine3f(Eigen::Translation3f(0, 0, static_cast<float>(world.board.piece_height_m))) * X_BO);
    }
  }
  const Eigen::Affine3f X_BR(world.X_RB.inverse().cast<float>());
  if (world.sheet) {
    items.push_back(sheet);
    items.back().X_BO = {
        Eigen::Affine3f(world.sheet->X_BS.cast<float>()) *
        Eigen::Scaling(static_cast<float>(world.sheet->size_x_m), static_cast<float>(world.sheet->size_y_m), 1.f)};
  }
  if (world.cup_R) {
    for (const DrawItem* part : {&cup, &coffee}) {
      items.push_back(*part);
      items.back().X_BO = {X_BR * Eigen::Translation3f(world.cup_R->cast<float>())};
    }
  }
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    items.push_back(objects.at(i));
    items.back().X_BO = {X_BR * Eigen::Affine3f(world.objects[i].X_RO.cast<float>())};
  }
  items.push_back(standing);
  items.push_back(piece_shadow);
  items.back().X_BO = standing.X_BO;
  const Lighting light = lighting(world);
  const std::vector<Circle> shadows = shadows_on_table(world, light);
  const auto in_shadow = [&](const Eigen::Vector2f& middle, float reach) {
    return std::any_of(shadows.begin(), shadows.end(), [&](const Circle& shadow) {
      return (shadow.middle_B - middle).norm() < shadow.radius_m + reach;
    });
  };
  for (const Furniture& piece : furniture) {
    if (piece.on_board && !world.board_present) continue;
    items.push_back(piece.item);
    DrawItem& item = items.back();
    if (!piece.on_board) item.X_BO[0] = X_BR * item.X_BO[0];
    if (piece.shadow_reach_m > 0 && !in_shadow(item.X_BO[0].translation().head<2>(), piece.shadow_reach_m)) {
      item.material.surface = painted;  // much cheaper, and the same colour where the light is whole
      item.material.colour = level_light(light);
    }
  }
  const float seen = painted_light(world);
  for (DrawItem& item : std::span(items).last(kPainted)) item.material.colour *= seen;
  return items;
}

cv::Mat Room::picture(const World& world, const View& view, const std::optional<cv::Rect>& box) {
  DrawOptions options;
  options.box = box;
  const Eigen::Vector3f ceiling = painted_light(world) * kWallPaint;  // beyond the walls
  options.background = {ceiling[2], ceiling[1], ceiling[0], 1};
  const Drawing drawing = state_->renderer->draw(view, state_->lighting(world), state_->items(world), options);
  cv::Mat bgr;
  cv::cvtColor(drawing.bgra, bgr, cv::COLOR_BGRA2BGR);
  return bgr;
}

cv::Mat Room::arm_mask(const World& world, const View& view) {
  std::vector<DrawItem> items = state_->items(world);
  const std::size_t parts = !world.player_present ? 0 : world.seated ? state_->figure_parts.size() : kArmParts;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const bool player = i < parts;
    items[i].material.surface = player ? SurfaceId::unlit : SurfaceId::catcher;
    if (player) items[i].material.texture = TextureId::white;
    if (player) items[i].material.colour = {1, 1, 1};
    items[i].casts_shadow = false;
  }
  Lighting no_shadows;
  no_shadows.shadow_radius_m = 0;
  const Drawing drawing = state_->renderer->draw(view, no_shadows, items);
  std::vector<cv::Mat> channels;
  cv::split(drawing.bgra, channels);
  return (channels[0] | channels[1] | channels[2]) > 0;
}

}  // namespace counterpart::stage
