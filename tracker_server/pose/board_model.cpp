#include "tracker_server/pose/model.hpp"

namespace counterpart {

Model board_model(const BoardGeometry& board) {
  Model model;
  const int n = board.squares;
  const double D = board.square_size_m, half = 0.5 * n * D;
  const auto corner = [&](int row, int col) { return Eigen::Vector3d(col * D - half, half - row * D, 0); };
  // The square at (0, 0) is never played on.
  const auto light = [&](int row, int col) {
    const bool played = (row + col) % 2 != 0;
    return played == (board.played_on == SquareColour::light);
  };
  ModelFace top;
  top.corners_M = {corner(n, 0), corner(n, n), corner(0, n), corner(0, 0)};
  top.normal_M = Eigen::Vector3d::UnitZ();
  model.faces.push_back(top);
  for (int line = 0; line <= n; ++line)
    for (int cell = 0; cell < n; ++cell) {
      const bool outline = line == 0 || line == n;
      // Along a row line, walking towards +x: the square on the right is the one below, (line, cell).
      ModelSegment across{corner(line, cell), corner(line, cell + 1)};
      if (!outline) across.polarity = light(line, cell) ? 1 : -1;
      // Along a column line, walking down the rows: the square on the right is (cell, line - 1).
      ModelSegment down{corner(cell, line), corner(cell + 1, line)};
      if (!outline) down.polarity = light(cell, line - 1) ? 1 : -1;
      for (ModelSegment* segment : {&across, &down}) {
        segment->face0 = 0;
        segment->outline = outline;
        model.segments.push_back(*segment);
      }
    }
  model.size_m = n * D;
  const auto middle = [&](std::size_t i) { return 0.5 * (model.segments[i].a_M + model.segments[i].b_M); };
  model.beside.resize(model.segments.size());
  for (std::size_t i = 0; i < model.segments.size(); ++i)
    for (std::size_t k = 0; k < model.segments.size(); ++k)
      if (k != i && (middle(i) - middle(k)).norm() < 1.2 * D) model.beside[i].push_back(static_cast<int>(k));
  return model;
}

}  // namespace counterpart
