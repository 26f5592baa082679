// A tracker's own poses.csv: one line a frame, columns as in docs/architecture.md.
#pragma once

#include <fstream>
#include <string>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/result.hpp"
#include "tracker_server/pipeline/observe.hpp"

namespace counterpart {

class PoseLog {
 public:
  // Empty name: nothing is written.
  [[nodiscard]] Result<void> open(const std::string& file);
  void add(const Frame& frame, const Observation& observation, const BoardGeometry& board);

 private:
  std::ofstream out_;
};

}  // namespace counterpart
