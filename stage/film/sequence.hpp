// Writes a film and its truth as a folder of pictures that trackers read.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "stage/film/film.hpp"

namespace counterpart::stage {

// One line of JSON without line break: frame, capture_ns, X_CB, intrinsics, occupancy, shares.
std::string truth_line(const Truth& truth);

class SequenceWriter {
 public:
  // Makes the folder and camera.json. Fails if the folder cannot be made or holds frames already.
  [[nodiscard]] static Result<SequenceWriter> create(const std::filesystem::path& folder, const Scenario& scenario);

  // frame_%05d.png, a line of poses.csv and truth.jsonl; init.json with the first.
  Result<void> write(const Shot& shot);

 private:
  std::filesystem::path folder_;
  std::ofstream poses_;
  std::ofstream truth_;
  bool begun_ = false;
};

}  // namespace counterpart::stage
