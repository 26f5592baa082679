// Lays the drawn scene over the camera's picture (the paper's section 4: blending with black as the key colour, done
// here with alpha, so that edges are soft and shadows fall on real things).
#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/video.hpp"

namespace counterpart {

// What is drawn for one camera frame. All pictures have the camera's size.
struct RenderedFrame {
  cv::Mat bgr;     // CV_8UC3; black wherever nothing virtual is seen, never quite black where something is
  cv::Mat alpha;   // CV_8UC1; 255 where something virtual is seen
  cv::Mat shadow;  // CV_8UC1; what the camera's picture is multiplied with, 255 = 1: shadows of virtual things
  cv::Rect box;    // outside of it there is nothing
};

enum class Blend : std::uint8_t {
  alpha = 1,      // soft edges, shadows
  black_key = 2,  // the paper's: a pixel that is not black replaces the camera's
};

struct CompositeOptions {
  Blend blend = Blend::alpha;
  bool shadows = true;
  double blur_px = 0.5;  // standard deviation of the camera's blur, put on the drawn part; 0..3
  double noise =
      0;  // standard deviation of the camera's noise in grey levels at mid grey, put on the drawn part; 0..20
  std::uint64_t seed = 0;  // of the noise; give the frame's id so that it changes from frame to frame
};

// frame_bgr: CV_8UC3 of the rendered frame's size. mask: what is in front of everything virtual (a real hand), or null;
// a mask of another size is left out. Returns a new picture.
cv::Mat composite(const cv::Mat& frame_bgr, const RenderedFrame& rendered, const Mask* mask,
                  const CompositeOptions& options);

// The mask as a picture, CV_8UC1, 255 = covered; empty if the runs do not make up a picture.
cv::Mat mask_picture(const Mask& mask);

// Splits what Renderer::draw gave for items of the kinds lit, cutout, unlit and catcher.
RenderedFrame split_drawing(const cv::Mat& bgra, const cv::Rect& box);

}  // namespace counterpart
