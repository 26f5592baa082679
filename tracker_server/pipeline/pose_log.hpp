// A tracker's own poses.csv: one line a frame, columns as in docs/architecture.md.
#pragma once

#include <fstream>
#include <optional>
#include <string>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/intrinsics.hpp"
#include "protocol/vocabulary/pose.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

class PoseLog {
 public:
  // Empty name: nothing is written.
  [[nodiscard]] Result<void> open(const std::string& file);

  // ms: from decoded picture to pose. A lost frame has no numbers but those of the frame and the time; a model that is
  // no board has no corners.
  void add(const PoseEstimate& pose, const Intrinsics& camera, const std::optional<BoardGeometry>& board, double ms);

  // Fails if not everything could be written.
  [[nodiscard]] Result<void> close();

 private:
  std::string file_;
  std::ofstream out_;
};

const char* csv_word(TrackStatus status);  // "ok" (relocalised too), "coasting", "lost"

}  // namespace counterpart
