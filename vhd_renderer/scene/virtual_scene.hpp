// Everything virtual, drawn for one camera frame: the human, his pieces, and black stand-ins for the real things that
// hide them and catch their shadows (the paper's section 4 and figure 8).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "protocol/vocabulary/result.hpp"
#include "protocol/vocabulary/scene.hpp"
#include "vhd_renderer/body/figure.hpp"
#include "vhd_renderer/composite/composite.hpp"
#include "vhd_renderer/draw/view.hpp"
#include "vhd_renderer/motion/director.hpp"

namespace counterpart {

class VirtualScene {
 public:
  // Pictures of this size. The figure is copied to the graphics memory; fails without OpenGL.
  [[nodiscard]] static Result<std::unique_ptr<VirtualScene>> create(int width, int height, const Figure& figure);
  ~VirtualScene();

  const std::string& description() const;  // of the OpenGL in use

  // The human as the performance poses him; `scene` gives board, light, boxes and real pieces, the performance gives
  // the virtual pieces. Without a box named "table" the table is a plane at the board's foot as far as the human's
  // edge.
  [[nodiscard]] Result<RenderedFrame> draw(const View& view, const Scene& scene, const Performance& performance,
                                           const std::vector<std::string>& morph_names);

  // The same with the human's vertices given, a SkinnedPart for each part of the figure; none: no human.
  [[nodiscard]] Result<RenderedFrame> draw(const View& view, const Scene& scene, std::span<const StagedPiece> pieces,
                                           std::span<const SkinnedPart> parts);

 private:
  struct State;
  explicit VirtualScene(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace counterpart
