// The squares read again and again: steadied over time, silent about what is covered.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/vocabulary/occupancy.hpp"
#include "tracker_server/pieces/appearance.hpp"
#include "tracker_server/pieces/board_view.hpp"

namespace counterpart {

struct PieceReading {
  Occupancy occupancy;
  std::vector<bool> covered_cells;  // by rows: a hand or a thing hides the square
};

class PieceReader {
 public:
  explicit PieceReader(int squares);

  // One of "wbWBe" a playable square, real pieces only; empty: nothing is expected.
  void expect(const std::string& real_squares) { expected_ = real_squares; }
  void forget();

  PieceReading read(const BoardView& view, const FrameStamp& stamp);

  // Whether what is seen is more like the expected position turned by 180 degrees than like the position itself.
  bool looks_turned_round() const;

 private:
  struct CellMemory {
    CellReading steady = CellReading::unknown;
    CellReading last = CellReading::unknown;
    int times = 0;  // that `last` was seen without a break
    float confidence = 0;
  };
  // From squares that look as expected: how much a piece stands out here, under this light.
  void learn(const Reading& now);

  int squares_;
  std::optional<double> threshold_;
  std::string expected_;
  std::vector<CellMemory> memory_;
  std::int64_t changed_ns_ = 0;
  bool started_ = false;
};

}  // namespace counterpart
