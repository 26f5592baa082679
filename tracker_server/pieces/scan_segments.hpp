// The paper's way of reading the board (section 3.1, equations 3 to 5).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/occupancy.hpp"
#include "tracker_server/pieces/board_view.hpp"

namespace counterpart {

// V of equation 5 for every square, by rows: the mean (the sum over its length) of the grey levels along the segment
// through the middle of the square's row; -1 for squares outside the picture.
std::vector<double> scan_values(const cv::Mat1b& grey, int squares, const BoardToPixel& to_pixel);

// The paper's threshold, learned.
struct ScanRule {
  double threshold = 0;     // between the two groups that the playable squares fall into
  bool pieces_dark = true;  // false: on dark squares the lighter ones carry the pieces
  bool from_known = false;  // learned from squares whose contents were known
};

// `expected` (one of "wbWBe" a playable square, or empty) names squares known to be empty or not, whose values then
// decide. parity: (row + col) % 2 of the squares that are played on; with anything expected it must be 1. Empty if too
// few squares are seen.
std::optional<ScanRule> scan_rule(const std::vector<double>& values, int squares, const std::string& expected,
                                  int parity = 1);

// Paper: a piece is where V <= threshold. Where empty squares are the darker ones it is the other way round.
std::vector<CellSight> read_scan(const std::vector<double>& values, int squares, double threshold, bool pieces_dark,
                                 int parity = 1);

}  // namespace counterpart
