// Grey pictures of one frame, each half the size of the one before.
#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

namespace counterpart {

struct Pyramid {
  std::vector<cv::Mat1b> levels;  // [0] has the frame's own size

  // A point of the frame's picture as a point of a level's picture, pixel centres at whole numbers.
  static float to_level(float x, int level) {
    const float scale = 1.0F / static_cast<float>(1 << level);
    return (x + 0.5F) * scale - 0.5F;
  }
};

// picture: CV_8UC3 (BGR) or CV_8UC1. Levels stop early before a side falls under 16 pixels.
Pyramid build_pyramid(const cv::Mat& picture, int levels);

}  // namespace counterpart
