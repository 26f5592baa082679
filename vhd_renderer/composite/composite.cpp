#include "vhd_renderer/composite/composite.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace counterpart {
namespace {

// (a * b) / 255, rounded, exact for bytes.
constexpr int times(int a, int b) {
  const int product = a * b + 128;
  return (product + (product >> 8)) >> 8;
}

cv::Rect grown(const cv::Rect& box, int by, const cv::Size& size) {
  return cv::Rect(box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by) & cv::Rect(cv::Point(), size);
}

// Takes the covered part out of the drawn picture: what is real and in front stays as the camera saw it.
void cut_out(cv::Mat& bgr, cv::Mat& alpha, cv::Mat& shadow, const cv::Mat& covered) {
  bgr.setTo(cv::Scalar::all(0), covered);
  alpha.setTo(0, covered);
  shadow.setTo(255, covered);
}

// Black stands for "nothing there"; colours are already multiplied with alpha, so a blur of both keeps edges right.
void blend_alpha(cv::Mat& picture, const cv::Mat& bgr, const cv::Mat& alpha, const cv::Mat& shadow) {
  for (int row = 0; row < picture.rows; ++row) {
    std::uint8_t* out = picture.ptr(row);
    const std::uint8_t* drawn = bgr.ptr(row);
    const std::uint8_t* a = alpha.ptr(row);
    const std::uint8_t* s = shadow.ptr(row);
    for (int col = 0; col < picture.cols; ++col, out += 3, drawn += 3) {
      if (a[col] == 0 && s[col] == 255) continue;
      const int keep = times(255 - a[col], s[col]);
      for (int c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>(std::min(255, drawn[c] + times(out[c], keep)));
    }
  }
}

void blend_black_key(cv::Mat& picture, const cv::Mat& bgr) {
  for (int row = 0; row < picture.rows; ++row) {
    std::uint8_t* out = picture.ptr(row);
    const std::uint8_t* drawn = bgr.ptr(row);
    for (int col = 0; col < picture.cols; ++col, out += 3, drawn += 3) {
      if ((drawn[0] | drawn[1] | drawn[2]) != 0) std::copy_n(drawn, 3, out);
    }
  }
}

// Grain like the camera's: stronger where it is brighter (shot noise), only where something was drawn.
void add_grain(cv::Mat& bgr, const cv::Mat& alpha, double sigma, std::uint64_t seed) {
  cv::RNG random(seed * 0x9E3779B97F4A7C15ULL + 1);
  std::array<std::int16_t, 4096> table{};
  for (std::int16_t& value : table) value = static_cast<std::int16_t>(std::lround(random.gaussian(sigma * 16)));
  std::array<int, 256> gain{};
  for (int level = 0; level < 256; ++level) {
    gain[static_cast<std::size_t>(level)] = static_cast<int>(16 * std::sqrt(0.25 + 0.75 * level / 128.0));
  }
  for (int row = 0; row < bgr.rows; ++row) {
    std::uint8_t* pixel = bgr.ptr(row);
    const std::uint8_t* a = alpha.ptr(row);
    std::uint32_t at = random.next();
    for (int col = 0; col < bgr.cols; ++col, pixel += 3) {
      if (a[col] == 0) continue;
      for (int c = 0; c < 3; ++c) {
        at = at * 1664525U + 1013904223U;
        const int change = table[at >> 20] * gain[pixel[c]] * a[col] / (256 * 255);
        pixel[c] = static_cast<std::uint8_t>(std::clamp(pixel[c] + change, 1, 255));
      }
    }
  }
}

}  // namespace

cv::Mat mask_picture(const Mask& mask) {
  const std::size_t pixels = std::size_t{mask.width} * mask.height;
  cv::Mat picture(mask.height, mask.width, CV_8UC1, cv::Scalar(0));
  std::size_t at = 0;
  bool covered = false;
  for (const std::uint32_t run : mask.runs) {
    if (run > pixels - at) return {};
    if (covered) std::fill_n(picture.data + at, run, std::uint8_t{255});
    at += run;
    covered = !covered;
  }
  return at == pixels ? picture : cv::Mat();
}

RenderedFrame split_drawing(const cv::Mat& bgra, const cv::Rect& box) {
  RenderedFrame frame;
  frame.box = box & cv::Rect(cv::Point(), bgra.size());
  frame.bgr = cv::Mat(bgra.size(), CV_8UC3, cv::Scalar::all(0));
  frame.alpha = cv::Mat(bgra.size(), CV_8UC1, cv::Scalar(0));
  frame.shadow = cv::Mat(bgra.size(), CV_8UC1, cv::Scalar(255));
  for (int row = frame.box.y; row < frame.box.y + frame.box.height; ++row) {
    const std::uint8_t* from = bgra.ptr(row, frame.box.x);
    std::uint8_t* colour = frame.bgr.ptr(row, frame.box.x);
    std::uint8_t* alpha = frame.alpha.ptr(row, frame.box.x);
    std::uint8_t* shadow = frame.shadow.ptr(row, frame.box.x);
    for (int col = 0; col < frame.box.width; ++col, from += 4, colour += 3) {
      const bool drawn = (from[0] | from[1] | from[2]) != 0;
      if (drawn) std::copy_n(from, 3, colour);
      alpha[col] = drawn ? 255 : 0;
      shadow[col] = drawn ? 255 : static_cast<std::uint8_t>(255 - from[3]);
    }
  }
  return frame;
}

cv::Mat composite(const cv::Mat& frame_bgr, const RenderedFrame& rendered, const Mask* mask,
                  const CompositeOptions& options) {
  cv::Mat result = frame_bgr.clone();
  if (rendered.box.empty() || rendered.bgr.size() != frame_bgr.size()) return result;
  const double sigma = std::clamp(options.blur_px, 0.0, 3.0);
  const int reach = static_cast<int>(std::ceil(2 * sigma));
  const cv::Rect box = grown(rendered.box, reach, frame_bgr.size());

  cv::Mat bgr = rendered.bgr(box).clone();
  cv::Mat alpha = rendered.alpha(box).clone();
  cv::Mat shadow = rendered.shadow(box).clone();
  if (mask != nullptr) {
    const cv::Mat covered = mask_picture(*mask);
    if (covered.size() == frame_bgr.size()) cut_out(bgr, alpha, shadow, covered(box));
  }
  cv::Mat part = result(box);
  if (options.blend == Blend::black_key) {
    blend_black_key(part, bgr);
    return result;
  }
  if (options.noise > 0) add_grain(bgr, alpha, std::min(options.noise, 20.0), options.seed);
  if (sigma > 0) {
    const cv::Size kernel(2 * reach + 1, 2 * reach + 1);
    cv::GaussianBlur(bgr, bgr, kernel, sigma, sigma, cv::BORDER_REPLICATE);
    cv::GaussianBlur(alpha, alpha, kernel, sigma, sigma, cv::BORDER_REPLICATE);
  }
  if (!options.shadows) shadow.setTo(255);
  blend_alpha(part, bgr, alpha, shadow);
  return result;
}

}  // namespace counterpart
