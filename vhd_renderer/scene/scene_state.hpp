// What a VirtualScene keeps between frames.
#pragma once

#include "vhd_renderer/draw/renderer.hpp"
#include "vhd_renderer/scene/virtual_scene.hpp"

namespace counterpart {

struct VirtualScene::State {
  Figure figure;  // as detailed as the picture can show
  std::unique_ptr<Renderer> renderer;
  std::vector<DrawItem> human;  // an item each part
  std::vector<SkinnedPart> skinned;
  // Made for a board; made again when another board comes.
  BoardGeometry board;
  bool furnished = false;
  MeshId piece_mesh{}, board_mesh{}, table_mesh{}, unit_box{}, chair_mesh{};
  TextureId grain{};

  Result<void> add_figure();
  Result<void> furnish(const BoardGeometry& geometry);
  std::vector<DrawItem> items(const Scene& scene, std::span<const StagedPiece> pieces,
                              std::span<const SkinnedPart> parts, const Eigen::Isometry3f* X_BC);
};

}  // namespace counterpart
