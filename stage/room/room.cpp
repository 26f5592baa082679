#include "stage/room/room.hpp"

#include <vector>

#include <opencv2/imgproc.hpp>

#include "stage/room/arm.hpp"
#include "stage/room/surfaces.hpp"
#include "stage/room/textures.hpp"
#include "vhd_renderer/draw/piece_shape.hpp"

namespace counterpart::stage {
namespace {

constexpr float kTableX_m = 1.3f;
constexpr float kTableNearY_m = 0.52f;  // the real player's edge
constexpr float kTableFarY_m = -0.42f;  // the virtual player's edge
constexpr float kTableThickness_m = 0.03f;
constexpr float kFloorZ_m = -0.755f;
constexpr float kWallY_m = -2.3f;

Eigen::Affine3f at(float x, float y, float z) {
  return Eigen::Affine3f(Eigen::Translation3f(x, y, z));
}

// The four upright sides of a box: its top and bottom are not seen.
MeshData skirt_mesh(const Eigen::Vector3f& size_m) {
  MeshData mesh = box_mesh(size_m);
  mesh.triangles.resize(4 * 6);
  return mesh;
}

}  // namespace

struct Room::State {
  RoomOptions options;
  std::unique_ptr<Renderer> renderer;
  std::vector<DrawItem> still;  // what never moves
  DrawItem pieces;
  DrawItem hand, forearm, upper_arm;

  Lighting lighting() const;
  std::vector<DrawItem> items(const World& world) const;
  Result<void> build();
};

Room::Room(std::unique_ptr<State> state) : state_(std::move(state)) {}
Room::~Room() = default;

Result<std::unique_ptr<Room>> Room::furnish(const RoomOptions& options) {
  auto state = std::make_unique<State>();
  state->options = options;
  auto renderer = Renderer::create(options.width, options.height, 1024);
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

  std::vector<SurfaceId> surfaces;
  for (const auto& [glsl, lit] : {std::pair{board_surface(), true},
                                  {table_surface(), true},
                                  {floor_surface(), false},
                                  {wall_surface(), false},
                                  {wooden_piece_surface(), true},
                                  {skin_surface(), true}}) {
    const Result<SurfaceId> surface = r.add_surface(glsl, lit);
    if (!surface) return tl::make_unexpected(surface.error());
    surfaces.push_back(*surface);
  }
  const bool dark_played = board.played_on == SquareColour::dark;
  r.set_parameters(surfaces[0], {static_cast<float>(board.squares), static_cast<float>(board.square_size_m),
                                 dark_played ? 1.f : 0.f, 0.f});

  const auto add = [&](const MeshData& mesh, SurfaceId surface, TextureId texture,
                       const Eigen::Affine3f& X_BO) -> Result<DrawItem> {
    const Result<MeshId> id = r.add_mesh(mesh);
    if (!id) return tl::make_unexpected(id.error());
    DrawItem item;
    item.mesh = *id;
    item.material.surface = surface;
    item.material.texture = texture;
    item.X_BO = {X_BO};
    item.casts_shadow = false;
    return item;
  };
  const TextureId grain = r.add_texture(wood_texture(512, 512, {236, 236, 236}, {170, 170, 170}, seed));
  const TextureId oak = r.add_texture(planks_texture(1024, 512, 5, {196, 158, 112}, {150, 108, 68}, seed + 1));
  const TextureId parquet = r.add_texture(planks_texture(1024, 1024, 16, {150, 112, 78}, {112, 78, 50}, seed + 2));
  const TextureId wall = r.add_texture(wall_texture(1600, 800, seed + 3));
  const TextureId cloth = r.add_texture(cloth_texture(256, 256, seed + 4));

  const float table_y = kTableNearY_m - kTableFarY_m;
  const float table_middle = (kTableNearY_m + kTableFarY_m) / 2;
  MeshData board_mesh = plane_mesh(side, side, 24, 24);
  struct Piece {
    MeshData mesh;
    SurfaceId surface;
    TextureId texture;
    Eigen::Affine3f X_BO;
    bool casts_shadow;
    float gloss, polish;
    Eigen::Vector3f colour;
  };
  MeshData wall_mesh = plane_mesh(7.f, 2.6f, 14, 6);
  const std::vector<Piece> furniture{
      {board_mesh, surfaces[0], grain, at(0, 0, 0), false, 0.10f, 40, {1, 1, 1}},
      {skirt_mesh({side, side, thickness}),
       SurfaceId::lit,
       grain,
       at(0, 0, -thickness / 2 - 0.0002f),
       true,
       0.1f,
       30,
       {0.13f, 0.06f, 0.03f}},
      {plane_mesh(kTableX_m, table_y, 26, 20),
       surfaces[1],
       oak,
       at(0, table_middle, -thickness),
       false,
       0.10f,
       28,
       {1, 1, 1}},
      {skirt_mesh({kTableX_m, table_y, kTableThickness_m}),
       SurfaceId::lit,
       oak,
       at(0, table_middle, -thickness - kTableThickness_m / 2 - 0.0005f),
       false,
       0.05f,
       20,
       {0.8f, 0.75f, 0.7f}},
      {plane_mesh(7.f, 5.f, 28, 20), surfaces[2], parquet, at(0, kWallY_m + 2.5f, kFloorZ_m), false, 0, 1, {1, 1, 1}},
      {wall_mesh,
       surfaces[3],
       wall,
       at(0, kWallY_m, kFloorZ_m + 1.3f) * Eigen::AngleAxisf(EIGEN_PI, Eigen::Vector3f::UnitZ()) *
           Eigen::AngleAxisf(static_cast<float>(EIGEN_PI) / 2, Eigen::Vector3f::UnitX()),
       false,
       0,
       1,
       {1, 1, 1}},
  };
  for (const Piece& piece : furniture) {
    Result<DrawItem> item = add(piece.mesh, piece.surface, piece.texture, piece.X_BO);
    if (!item) return tl::make_unexpected(item.error());
    item->casts_shadow = piece.casts_shadow;
    item->material.gloss = piece.gloss;
    item->material.polish = piece.polish;
    item->material.colour = piece.colour;
    still.push_back(*item);
  }

  const auto movable = [&](DrawItem& slot, const MeshData& mesh, SurfaceId surface, TextureId texture,
                           const Eigen::Vector3f& colour, float gloss, float polish) -> Result<void> {
    Result<DrawItem> item = add(mesh, surface, texture, Eigen::Affine3f::Identity());
    if (!item) return tl::make_unexpected(item.error());
    slot = *item;
    slot.casts_shadow = true;
    slot.material.colour = colour;
    slot.material.gloss = gloss;
    slot.material.polish = polish;
    return {};
  };
  const auto radius = static_cast<float>(board.piece_radius_m);
  const Eigen::Vector3f shirt(0.09f, 0.15f, 0.26f);
  Result<void> made = movable(pieces, piece_shape(board, 28), surfaces[4], grain, {0.085f, 0.032f, 0.016f}, 0.22f, 36);
  if (made)
    made = movable(hand, blended(hand_capsules(radius), 0.010f, 0.0048f), surfaces[5], TextureId::white,
                   {0.62f, 0.36f, 0.26f}, 0.10f, 14);
  if (made)
    made = movable(forearm, sleeve_mesh(static_cast<float>(kForearm_m) - 0.02f, 0.056f, 0.038f), SurfaceId::lit, cloth,
                   shirt, 0.01f, 8);
  if (made)
    made = movable(upper_arm, sleeve_mesh(static_cast<float>(kUpperArm_m) + 0.03f, 0.066f, 0.056f), SurfaceId::lit,
                   cloth, shirt, 0.01f, 8);
  forearm.material.double_sided = true;
  upper_arm.material.double_sided = true;
  return made;
}

Lighting Room::State::lighting() const {
  Lighting light;
  light.direction_B = options.light_direction_B;
  light.colour = Eigen::Vector3f(0.98f, 0.93f, 0.84f) * options.light;
  light.ambient_up = Eigen::Vector3f(0.36f, 0.37f, 0.40f) * (0.15f + 0.85f * options.light);
  light.ambient_down = Eigen::Vector3f(0.20f, 0.17f, 0.14f) * (0.15f + 0.85f * options.light);
  light.shadow_centre_B = {0, 0.1f, 0};
  light.shadow_radius_m = 0.55f;
  light.softness_m = 0.007f;
  return light;
}

std::vector<DrawItem> Room::State::items(const World& world) const {
  std::vector<DrawItem> items;  // near things first
  DrawItem standing = pieces;
  standing.X_BO.clear();
  for (const RealPiece& piece : world.pieces) {
    Eigen::Affine3f X_BO(Eigen::Translation3f(piece.p_B.cast<float>()));
    X_BO.rotate(Eigen::AngleAxisf(static_cast<float>(piece.turn_rad), Eigen::Vector3f::UnitZ()));
    standing.X_BO.push_back(X_BO);
    if (piece.king) {
      standing.X_BO.push_back(
          Eigen::Affine3f(Eigen::Translation3f(0, 0, static_cast<float>(world.board.piece_height_m))) * X_BO);
    }
  }
  if (world.player_present) {
    const ArmPose pose = arm_for(world.hand.pinch_B);
    for (const auto& [item, X] :
         {std::pair{&hand, &pose.X_BHand}, {&forearm, &pose.X_BForearm}, {&upper_arm, &pose.X_BUpperArm}}) {
      items.push_back(*item);
      items.back().X_BO = {Eigen::Affine3f(X->cast<float>())};
    }
  }
  items.push_back(standing);
  items.insert(items.end(), still.begin(), still.end());
  return items;
}

cv::Mat Room::picture(const World& world, const View& view) {
  const Drawing drawing = state_->renderer->draw(view, state_->lighting(), state_->items(world));
  cv::Mat bgr;
  cv::cvtColor(drawing.bgra, bgr, cv::COLOR_BGRA2BGR);
  return bgr;
}

cv::Mat Room::arm_mask(const World& world, const View& view) {
  std::vector<DrawItem> items = state_->items(world);
  const std::size_t arm_parts = world.player_present ? 3 : 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const bool arm = i < arm_parts;
    items[i].material.surface = arm ? SurfaceId::unlit : SurfaceId::catcher;
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
