// A figure as a renderer draws it.
#pragma once

#include <vector>

#include "vhd_renderer/body/figure.hpp"
#include "vhd_renderer/draw/renderer.hpp"

namespace counterpart {

// Copies the figure's parts and textures to the renderer; an item each part, in their order. Vertices then move by
// Renderer::update_mesh.
[[nodiscard]] Result<std::vector<DrawItem>> figure_items(const Figure& figure, Renderer& renderer);

// What a picture of this height (pixels) cannot show of somebody who sits as near as people sit: see simplified().
float unseen_error_m(int height);

}  // namespace counterpart
