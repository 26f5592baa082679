// Points where four squares meet: light, dark, light, dark.
#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

namespace counterpart {

struct Saddle {
  cv::Point2f p;  // pixels, sub-pixel
  // Directions of the two edges through it, radians modulo pi. Turning from edge[0] to edge[1] (x towards y) crosses a
  // light square; at the next corner of a chequer pattern the two are therefore exchanged.
  float edge[2] = {0, 0};
  float strength = 0;  // grey levels between its light and its dark squares
};

// Strongest first, at most `limit`. Squares should measure at least about 12 pixels.
std::vector<Saddle> find_saddles(const cv::Mat1b& grey, float min_strength, std::size_t limit);

}  // namespace counterpart
