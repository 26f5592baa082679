// Writes a film and its truth as a folder of pictures that trackers read.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "stage/film/film.hpp"

namespace counterpart::stage {

// One line of JSON without line break: frame, capture_ns, X_CB, intrinsics, occupancy, shares.
std::string truth_line(const Truth& truth);

class SequenceWriter {
 public:
  // Makes the folder, camera.json and the models of the objects. Fails if the folder cannot be made or holds frames
  // already.
  [[nodiscard]] static Result<SequenceWriter> create(const std::filesystem::path& folder, const Scenario& scenario);

  // frame_%05d.png, a line of each poses.csv and of truth.jsonl; init.json with the first.
  Result<void> write(const Shot& shot);

 private:
  // What has a pose: the board, or an object in a folder of its own.
  struct Track {
    std::filesystem::path folder;
    std::ofstream poses;
  };
  Result<void> write_pose(Track& track, unsigned long frame, const Eigen::Isometry3d& X_CM);

  std::filesystem::path folder_;
  std::vector<Track> tracks_;
  bool board_present_ = true;
  std::ofstream truth_;
  bool begun_ = false;
};

}  // namespace counterpart::stage
