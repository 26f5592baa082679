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

// Of the human: the triangles that a picture of this height can show, or all that he has.
enum class LevelOfDetail { of_the_picture, all };

class VirtualScene {
 public:
  // Pictures of this size. The figure is copied to the graphics memory; fails without OpenGL.
  [[nodiscard]] static Result<std::unique_ptr<VirtualScene>> create(
      int width, int height, const Figure& figure, LevelOfDetail detail = LevelOfDetail::of_the_picture);
  ~VirtualScene();

  const std::string& description() const;  // of the OpenGL in use
  std::size_t human_triangles() const;

  // The human as the performance poses him; `scene` gives board, light, boxes and real pieces, the performance gives
  // the virtual pieces. Without a box named "table" the table is a plane at the board's foot as far as the human's
  // edge.
  [[nodiscard]] Result<RenderedFrame> draw(const View& view, const Scene& scene, const Performance& performance,
                                           const std::vector<std::string>& morph_names);

  // The same with the human's vertices given, a SkinnedPart for each part of the figure; none: no human.
  // `X_BC`: his chair, or null.
  [[nodiscard]] Result<RenderedFrame> draw(const View& view, const Scene& scene, std::span<const StagedPiece> pieces,
                                           std::span<const SkinnedPart> parts, const Eigen::Isometry3f* X_BC = nullptr);

 private:
  struct State;
  explicit VirtualScene(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace counterpart
