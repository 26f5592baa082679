// What a real camera does to a clean picture.
#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

namespace counterpart::stage {

struct SensorOptions {
  double blur_px = 0.55;  // standard deviation of the lens's and sensor's blur; 0..5
  double noise = 2.0;     // standard deviation at mid grey, in grey levels; 0..30; grows with brightness
};

// bgr: CV_8UC3, changed in place. The same frame number and seed give the same bytes.
void expose(cv::Mat& bgr, const SensorOptions& options, std::uint64_t seed, std::uint64_t frame);

}  // namespace counterpart::stage
