#include "vhd_renderer/scene/figure_items.hpp"

namespace counterpart {

float unseen_error_m(int height) {
  constexpr float kNearest_m = 0.8f;
  constexpr float kFocalHeights = 1.1f;  // a usual focal length, in heights of the picture
  constexpr float kPixels = 0.35f;
  return kPixels * kNearest_m / (kFocalHeights * static_cast<float>(height));
}

Result<std::vector<DrawItem>> figure_items(const Figure& figure, Renderer& renderer) {
  std::vector<DrawItem> items;
  std::vector<TextureId> textures;
  for (const Texture& texture : figure.textures) textures.push_back(renderer.add_texture(texture));
  for (const FigurePart& part : figure.parts) {
    MeshData mesh{part.positions_m, part.normals, part.uvs, part.triangles};
    mesh.uvs.resize(mesh.positions_m.size(), Eigen::Vector2f::Zero());
    const Result<MeshId> id = renderer.add_mesh(mesh);
    if (!id)
      return failure(id.error().code,
                     "Part " + part.name + " of the figure " + figure.name + ": " + id.error().message);
    DrawItem item;
    item.mesh = *id;
    item.material.surface = part.alpha == AlphaMode::cutout ? SurfaceId::cutout : SurfaceId::lit;
    if (part.texture >= 0 && static_cast<std::size_t>(part.texture) < textures.size()) {
      item.material.texture = textures[static_cast<std::size_t>(part.texture)];
    }
    item.material.colour = part.colour;
    item.material.gloss = 0.05f;
    item.material.polish = 16;
    item.material.double_sided = part.double_sided;
    // Small inner parts cost much in the shadow map and show nothing.
    item.casts_shadow = part.name.find("eye") == std::string::npos && part.name.find("teeth") == std::string::npos &&
                        part.name.find("tongue") == std::string::npos;
    items.push_back(item);
  }
  return items;
}

}  // namespace counterpart
