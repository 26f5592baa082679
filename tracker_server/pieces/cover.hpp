// What hides the board: a hand, a sleeve, a newspaper.
#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

#include "tracker_server/pieces/appearance.hpp"
#include "tracker_server/pieces/board_view.hpp"

namespace counterpart {

struct Cover {
  std::vector<bool> cells;  // by rows: so much of the square is hidden that nothing is said about it
  // squares * patch_side a side, as seen straight from above: 255 where the board is hidden, in and round those cells.
  cv::Mat1b samples;
  bool any = false;
};

// Share of a square that must differ from the empty board for it to count as hidden.
constexpr float covered_share = 0.5F;

// was_empty: by rows, squares that were seen empty before; what now differs in one of them beside the cover belongs to
// it.
Cover find_cover(const BoardView& view, const std::vector<CellLook>& looks, const std::vector<bool>& was_empty,
                 const GroundTolerance& most = {});

}  // namespace counterpart
