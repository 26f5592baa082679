// The squares read again and again: steadied over time, silent about what is covered.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/vocabulary/occupancy.hpp"
#include "tracker_server/pieces/appearance.hpp"
#include "tracker_server/pieces/board_view.hpp"
#include "tracker_server/pieces/calibration.hpp"
#include "tracker_server/pieces/cover.hpp"
#include "tracker_server/pieces/scan_segments.hpp"

namespace counterpart {

enum class ReadingMethod {
  appearance = 1,     // how each square differs from the empty board
  scan_segments = 2,  // the paper's: the sum of grey levels along a segment, against a threshold
};

struct PieceReading {
  Occupancy occupancy;
  Cover cover;
};

class PieceReader {
 public:
  explicit PieceReader(int squares, ReadingMethod method = ReadingMethod::appearance);

  // One of "wbWBe" a playable square, real pieces only; empty: nothing is expected.
  void expect(const std::string& real_squares) { expected_ = real_squares; }
  void forget();

  // scan: scan_values of the same picture; only looked at by ReadingMethod::scan_segments.
  PieceReading read(const BoardView& view, const FrameStamp& stamp, const std::vector<double>& scan = {});

  // Whether what is seen is more like the expected position turned by 180 degrees than like the position itself.
  bool looks_turned_round() const;

 private:
  struct CellMemory {
    CellReading steady = CellReading::unknown;
    CellReading last = CellReading::unknown;
    int times = 0;  // that `last` was seen without a break
    float confidence = 0;
  };
  Reading read_now(const std::vector<CellLook>& looks, const std::vector<double>& scan);
  void learn(const BoardView& view, const std::vector<CellLook>& looks);
  void learn_tolerance(const BoardView& view, const std::vector<CellLook>& looks, const BoardLight& light);

  int squares_;
  ReadingMethod method_;
  SquareCalibration calibration_;
  GroundTolerance tolerance_;
  std::optional<ScanRule> scan_rule_;
  std::string expected_;
  std::vector<CellMemory> memory_;
  std::int64_t changed_ns_ = 0;
  std::int64_t read_ns_ = 0;  // the last picture
  bool started_ = false;
};

}  // namespace counterpart
