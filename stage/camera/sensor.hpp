// What a real camera does to a clean picture.
#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

namespace counterpart::stage {

struct SensorOptions {
  double blur_px = 0.55;         // standard deviation of the lens's and sensor's blur; 0..5
  double noise = 2.0;            // standard deviation at mid grey, in grey levels; 0..30; grows with brightness
  double exposure_drift_ev = 0;  // the exposure swings by so many stops to each side
  double white_drift = 0;        // red rises by this share while blue falls, and back
  double drift_period_s = 8;
  int jpeg_quality = 0;  // 1..100: the picture is squeezed through JPEG; 0: it is not
};

// What the drifts multiply the light of blue, green and red by.
cv::Vec3d drift_gain(const SensorOptions& options, double t_s);

// gain: of the light, for blue, green and red. bgr: CV_8UC3, changed in place. The same frame number and seed give the
// same bytes.
void expose(cv::Mat& bgr, const SensorOptions& options, std::uint64_t seed, std::uint64_t frame,
            const cv::Vec3d& gain = {1, 1, 1});

}  // namespace counterpart::stage
