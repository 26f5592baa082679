#include "vhd_renderer/draw/piece_shape.hpp"

namespace counterpart {

MeshData piece_shape(const BoardGeometry& board, int segments) {
  const auto r = static_cast<float>(board.piece_radius_m);
  const auto h = static_cast<float>(board.piece_height_m);
  // A point given twice is a sharp corner.
  const std::vector<Eigen::Vector2f> profile{{0.92f * r, 0},         {0.985f * r, 0.08f * h}, {r, 0.25f * h},
                                             {r, 0.75f * h},         {0.985f * r, 0.92f * h}, {0.93f * r, h},
                                             {0.78f * r, h},         {0.78f * r, h},          {0.72f * r, 0.84f * h},
                                             {0.72f * r, 0.84f * h}, {0.52f * r, 0.84f * h},  {0.52f * r, 0.84f * h},
                                             {0.46f * r, 0.95f * h}, {0.46f * r, 0.95f * h},  {0, 0.95f * h}};
  return lathe_mesh(profile, segments);
}

}  // namespace counterpart
