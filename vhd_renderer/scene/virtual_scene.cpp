#include "vhd_renderer/scene/virtual_scene.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "protocol/vocabulary/pose_eigen.hpp"
#include "vhd_renderer/body/simplify.hpp"
#include "vhd_renderer/draw/piece_shape.hpp"
#include "vhd_renderer/motion/stance.hpp"
#include "vhd_renderer/scene/chair_shape.hpp"
#include "vhd_renderer/scene/figure_items.hpp"
#include "vhd_renderer/scene/scene_state.hpp"

namespace counterpart {
namespace {

constexpr float kTableWidth_m = 1.6f;  // if nobody says how wide it is

Eigen::Affine3f at(const Eigen::Vector3f& p_B) {
  return Eigen::Affine3f(Eigen::Translation3f(p_B));
}

float half_side_m(const BoardGeometry& board) {
  return static_cast<float>(board.squares * board.square_size_m / 2 + board.border_m);
}

DrawItem catcher(MeshId mesh, const Eigen::Affine3f& X_BO) {
  DrawItem item;
  item.mesh = mesh;
  item.material.surface = SurfaceId::catcher;
  item.X_BO = {X_BO};
  item.casts_shadow = false;
  return item;
}

// Wood grain of one colour, for the virtual pieces: rings seen from above.
Texture grain_texture() {
  constexpr int kSize = 128;
  Texture texture{kSize, kSize, {}};
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const double line = 0.5 + 0.5 * std::sin(0.55 * y + 2.5 * std::sin(0.05 * x) + 1.3 * std::sin(0.21 * y));
      const auto level = static_cast<std::uint8_t>(228 + 27 * line);
      texture.rgba.insert(texture.rgba.end(), {level, level, level, 255});
    }
  }
  return texture;
}

Lighting lighting_of(const SceneLight& light) {
  Lighting result;
  result.direction_B = to_eigen(light.direction_B).cast<float>();
  result.colour = to_eigen(light.colour).cast<float>();
  result.ambient_up = to_eigen(light.ambient).cast<float>();
  result.ambient_down = 0.6f * result.ambient_up;
  return result;
}

// Where in the picture anything drawn may lie. Margin for what a shadow's softness and rounding add.
cv::Rect box_of(const View& view, std::span<const Eigen::Vector3f> points_B) {
  const cv::Rect whole(0, 0, view.intrinsics.width, view.intrinsics.height);
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const Eigen::Vector3f& p : points_B) {
    const Eigen::Vector3d p_B = p.cast<double>();
    if ((view.X_CB * p_B).z() < 2 * kNear_m) return whole;
    const Eigen::Vector2d at_px = project(view, p_B);
    low = low.cwiseMin(at_px);
    high = high.cwiseMax(at_px);
  }
  if (high.x() < low.x()) return {};
  const Eigen::Vector2d size(whole.width, whole.height);
  low = (low.array() - 6).max(0).matrix();
  high = (high.array() + 7).matrix().cwiseMin(size);
  if (high.x() <= low.x() || high.y() <= low.y()) return {};
  return cv::Rect(cv::Point(static_cast<int>(low.x()), static_cast<int>(low.y())),
                  cv::Point(static_cast<int>(std::ceil(high.x())), static_cast<int>(std::ceil(high.y())))) &
         whole;
}

// Where the shadow of a point falls on the plane z = height; far away if the light is too low.
Eigen::Vector3f shadow_on_plane(const Eigen::Vector3f& p, const Eigen::Vector3f& to_light, float height) {
  if (p.z() <= height || to_light.z() < 0.2f * to_light.norm()) return p;
  return p - to_light * ((p.z() - height) / to_light.z());
}

}  // namespace

VirtualScene::VirtualScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
VirtualScene::~VirtualScene() = default;

const std::string& VirtualScene::description() const {
  return state_->renderer->description();
}

std::size_t VirtualScene::human_triangles() const {
  std::size_t count = 0;
  for (const FigurePart& part : state_->figure.parts) count += part.triangles.size() / 3;
  return count;
}

Result<std::unique_ptr<VirtualScene>> VirtualScene::create(int width, int height, const Figure& figure,
                                                           LevelOfDetail detail) {
  auto state = std::make_unique<State>();
  state->figure = detail == LevelOfDetail::all ? figure : simplified(figure, unseen_error_m(height));
  auto renderer = Renderer::create(width, height, 1024);
  if (!renderer) return tl::make_unexpected(renderer.error());
  state->renderer = std::move(*renderer);
  if (const Result<void> added = state->add_figure(); !added) return tl::make_unexpected(added.error());
  return std::unique_ptr<VirtualScene>(new VirtualScene(std::move(state)));
}

Result<void> VirtualScene::State::add_figure() {
  Result<std::vector<DrawItem>> items = figure_items(figure, *renderer);
  if (!items) return tl::make_unexpected(items.error());
  human = *std::move(items);
  grain = renderer->add_texture(grain_texture());
  return {};
}

Result<void> VirtualScene::State::furnish(const BoardGeometry& geometry) {
  if (furnished && geometry == board) return {};
  const float side = 2 * half_side_m(geometry);
  const auto thickness = static_cast<float>(geometry.thickness_m);
  MeshData board_body = box_mesh({side, side, thickness});
  for (Eigen::Vector3f& p : board_body.positions_m) p.z() -= thickness / 2;
  append(board_body, plane_mesh(side, side, 16, 16), {0, 0, 0});
  for (const auto& [id, mesh] :
       {std::pair{&piece_mesh, piece_shape(geometry, 36)},
        {&board_mesh, board_body},
        {&table_mesh, plane_mesh(kTableWidth_m, 2 * (side / 2 + usual_table_beyond_board_m), 24, 16)},
        {&unit_box, box_mesh({1, 1, 1})},
        {&chair_mesh, chair_shape()}}) {
    const Result<MeshId> added = renderer->add_mesh(mesh);
    if (!added) return tl::make_unexpected(added.error());
    *id = *added;
  }
  board = geometry;
  furnished = true;
  return {};
}

std::vector<DrawItem> VirtualScene::State::items(const Scene& scene, std::span<const StagedPiece> pieces,
                                                 std::span<const SkinnedPart> parts, const Eigen::Isometry3f* X_BC) {
  std::vector<DrawItem> result;  // near things first
  const auto height = static_cast<float>(scene.board.piece_height_m);

  DrawItem real = catcher(piece_mesh, {});
  real.X_BO.clear();
  for (const ScenePiece& piece : scene.pieces) {
    if (!piece.real) continue;
    const Eigen::Vector3f foot = to_eigen(piece.p_B).cast<float>();
    for (int storey = 0; storey < (piece.king ? 2 : 1); ++storey) {
      real.X_BO.push_back(at(foot + Eigen::Vector3f(0, 0, static_cast<float>(storey) * height)));
    }
  }
  result.push_back(real);

  for (const Side side : {Side::light, Side::dark}) {
    DrawItem item;
    item.mesh = piece_mesh;
    item.material.texture = grain;
    item.material.colour =
        side == Side::light ? Eigen::Vector3f(0.72f, 0.53f, 0.31f) : Eigen::Vector3f(0.085f, 0.032f, 0.016f);
    item.material.gloss = 0.22f;
    item.material.polish = 36;
    item.X_BO.clear();
    for (const StagedPiece& piece : pieces) {
      if (piece.side != side) continue;
      for (int storey = 0; storey < (piece.king ? 2 : 1); ++storey) {
        const Eigen::Isometry3f X_BP = piece.X_BP * Eigen::Translation3f(0, 0, static_cast<float>(storey) * height);
        item.X_BO.push_back(Eigen::Affine3f(X_BP));
      }
    }
    result.push_back(item);
  }

  result.push_back(catcher(board_mesh, at({0, 0, 0})));
  bool table_known = false;
  for (const SceneBox& box : scene.boxes) {
    Eigen::Affine3f X_BO(to_eigen(box.X_BO).cast<float>());
    result.push_back(catcher(unit_box, X_BO * Eigen::Scaling(to_eigen(box.size_m).cast<float>().eval())));
    table_known = table_known || box.name == "table";
  }
  if (!table_known) result.push_back(catcher(table_mesh, at({0, 0, -static_cast<float>(scene.board.thickness_m)})));

  for (std::size_t i = 0; i < human.size() && i < parts.size(); ++i) {
    if (parts[i].positions_m.size() != figure.parts[i].positions_m.size()) continue;
    renderer->update_mesh(human[i].mesh, parts[i].positions_m, parts[i].normals);
    result.push_back(human[i]);
  }
  if (X_BC != nullptr) {
    DrawItem chair;
    chair.mesh = chair_mesh;
    chair.material.texture = grain;
    chair.material.colour = {0.20f, 0.105f, 0.05f};
    chair.material.gloss = 0.12f;
    chair.X_BO = {Eigen::Affine3f(*X_BC)};
    result.push_back(chair);
  }
  return result;
}

Result<RenderedFrame> VirtualScene::draw(const View& view, const Scene& scene, std::span<const StagedPiece> pieces,
                                         std::span<const SkinnedPart> parts, const Eigen::Isometry3f* X_BC) {
  State& s = *state_;
  if (view.intrinsics.width != s.renderer->width() || view.intrinsics.height != s.renderer->height()) {
    return failure(ErrorCode::invalid_argument, "The camera's picture is " + std::to_string(view.intrinsics.width) +
                                                    "x" + std::to_string(view.intrinsics.height) +
                                                    ", this scene draws " + std::to_string(s.renderer->width()) + "x" +
                                                    std::to_string(s.renderer->height()) + ".");
  }
  if (!view.X_CB.matrix().allFinite()) return failure(ErrorCode::not_a_number, "The camera's pose is not a number.");
  if (const Result<void> furnished = s.furnish(scene.board); !furnished) return tl::make_unexpected(furnished.error());

  Lighting light = lighting_of(scene.light);
  const Eigen::Vector3f to_light = light.direction_B.normalized();
  const float table_z = -static_cast<float>(scene.board.thickness_m);

  // Every drawn point and its shadow on the table decide which part of the picture is touched. Of fine meshes every
  // fourth vertex will do, since the box is grown a little.
  std::vector<Eigen::Vector3f> extent;
  const auto add = [&](const Eigen::Vector3f& p) {
    extent.push_back(p);
    extent.push_back(shadow_on_plane(p, to_light, table_z));
  };
  const auto radius = static_cast<float>(scene.board.piece_radius_m);
  for (const StagedPiece& piece : pieces) {
    const Eigen::Vector3f foot = piece.X_BP.translation();
    for (const float dx : {-1.5f, 1.5f}) {
      for (const float dy : {-1.5f, 1.5f}) {
        for (const float z : {-0.5f, 2.5f}) add(foot + Eigen::Vector3f(dx * radius, dy * radius, z * radius));
      }
    }
  }
  if (X_BC != nullptr) {
    for (const Eigen::Vector3f& p : chair_shape().positions_m) add(*X_BC * p);
  }
  Eigen::AlignedBox3f body;
  for (const SkinnedPart& part : parts) {
    const std::size_t step = part.positions_m.size() > 2000 ? 4 : 1;
    for (std::size_t i = 0; i < part.positions_m.size(); i += step) {
      body.extend(part.positions_m[i]);
      add(part.positions_m[i]);  // legs too: they show beside a table and under it
    }
  }
  DrawOptions options;
  options.box = box_of(view, extent);

  light.shadow_centre_B = {0, 0, 0.1f};
  light.shadow_radius_m = 0.6f;
  if (!body.isEmpty()) {
    Eigen::AlignedBox3f shaded(Eigen::Vector3f(-0.3f, -0.3f, table_z), Eigen::Vector3f(0.3f, 0.3f, 0.05f));
    shaded.extend(body.min().cwiseMax(Eigen::Vector3f(-1.5f, -1.5f, table_z)));
    shaded.extend(body.max().cwiseMin(Eigen::Vector3f(1.5f, 1.5f, 1.5f)));
    light.shadow_centre_B = shaded.center();
    light.shadow_radius_m = 0.5f * shaded.diagonal().norm();
  }
  const Drawing drawing = s.renderer->draw(view, light, s.items(scene, pieces, parts, X_BC), options);
  return split_drawing(drawing.bgra, *options.box);
}

}  // namespace counterpart
