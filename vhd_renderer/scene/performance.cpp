#include "vhd_renderer/scene/scene_state.hpp"
#include "vhd_renderer/scene/virtual_scene.hpp"

namespace counterpart {

Result<RenderedFrame> VirtualScene::draw(const View& view, const Scene& scene, const Performance& performance,
                                         const std::vector<std::string>& morph_names) {
  skin(state_->figure, morph_names, performance, state_->skinned);
  return draw(view, scene, performance.pieces, state_->skinned, performance.X_BC ? &*performance.X_BC : nullptr);
}

}  // namespace counterpart
