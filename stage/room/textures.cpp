#include "stage/room/textures.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace counterpart::stage {
namespace {

// Noise in 0..1 (mean a half) whose features are about cell_x by cell_y pixels.
cv::Mat smooth_noise(int width, int height, double cell_x, double cell_y, cv::RNG& random) {
  cv::Mat coarse(std::max(2, static_cast<int>(height / cell_y)), std::max(2, static_cast<int>(width / cell_x)), CV_32F);
  random.fill(coarse, cv::RNG::UNIFORM, 0, 1);
  coarse.col(0).copyTo(coarse.col(coarse.cols - 1));
  cv::Mat fine;
  cv::resize(coarse, fine, cv::Size(width, height), 0, 0, cv::INTER_CUBIC);
  return fine;
}

Texture to_texture(const cv::Mat& rgb) {
  cv::Mat rgba;
  cv::cvtColor(rgb, rgba, cv::COLOR_RGB2RGBA);
  return {rgba.cols, rgba.rows, std::vector<std::uint8_t>(rgba.datastart, rgba.dataend)};
}

cv::Mat wood(int width, int height, const Eigen::Vector3f& light, const Eigen::Vector3f& dark, cv::RNG& random) {
  const cv::Mat sway = smooth_noise(width, height, width / 3.0, height / 3.0, random);
  const cv::Mat fibre = smooth_noise(width, height, 60, 1.2, random);
  const cv::Mat streak = smooth_noise(width, height, width / 2.0, 6, random);
  const cv::Mat pore = smooth_noise(width, height, 14, 1.0, random);
  cv::Mat rgb(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float rings = 0.5f + 0.5f * std::sin(0.35f * static_cast<float>(y) + 9.f * sway.at<float>(y, x));
      float late = 0.22f * rings + 0.38f * fibre.at<float>(y, x) + 0.40f * streak.at<float>(y, x);
      if (pore.at<float>(y, x) > 0.93f) late += 0.25f;
      late = std::clamp(late, 0.f, 1.f);
      const Eigen::Vector3f colour = light + late * (dark - light);
      rgb.at<cv::Vec3b>(y, x) = {cv::saturate_cast<std::uint8_t>(colour.x()),
                                 cv::saturate_cast<std::uint8_t>(colour.y()),
                                 cv::saturate_cast<std::uint8_t>(colour.z())};
    }
  }
  return rgb;
}

void rectangle(cv::Mat& rgb, double x0, double y0, double x1, double y1, const cv::Scalar& colour) {
  // Shares of the picture, so that its size does not matter.
  cv::rectangle(rgb, cv::Point(static_cast<int>(x0 * rgb.cols), static_cast<int>(y0 * rgb.rows)),
                cv::Point(static_cast<int>(x1 * rgb.cols) - 1, static_cast<int>(y1 * rgb.rows) - 1), colour,
                cv::FILLED);
}

void books(cv::Mat& rgb, double x0, double y0, double x1, double y1, cv::RNG& random) {
  static const cv::Scalar covers[] = {{120, 44, 38},   {38, 60, 92}, {46, 84, 62},  {168, 140, 92}, {70, 56, 70},
                                      {188, 176, 150}, {52, 50, 48}, {140, 92, 50}, {96, 104, 110}};
  double x = x0;
  while (x < x1 - 0.004) {
    const double width = random.uniform(0.004, 0.011);
    const double top = y0 + (y1 - y0) * random.uniform(0.05, 0.35);
    if (random.uniform(0.0, 1.0) > 0.12) {
      const cv::Scalar cover = covers[random.uniform(0, 9)] * random.uniform(0.75, 1.1);
      rectangle(rgb, x, top, std::min(x + width, x1), y1, cover);
      rectangle(rgb, x, top + (y1 - top) * 0.2, std::min(x + width * 0.8, x1), top + (y1 - top) * 0.26, cover * 1.35);
    }
    x += width;
  }
}

}  // namespace

Texture wood_texture(int width, int height, const Eigen::Vector3f& light, const Eigen::Vector3f& dark,
                     std::uint64_t seed) {
  cv::RNG random(seed + 1);
  return to_texture(wood(width, height, light, dark, random));
}

Texture planks_texture(int width, int height, int planks, const Eigen::Vector3f& light, const Eigen::Vector3f& dark,
                       std::uint64_t seed) {
  cv::RNG random(seed + 1);
  cv::Mat rgb(height, width, CV_8UC3);
  for (int plank = 0; plank < planks; ++plank) {
    const int top = plank * height / planks;
    const int tall = (plank + 1) * height / planks - top;
    cv::Mat one = wood(width, tall, light, dark, random) * random.uniform(0.82, 1.06);
    cv::line(one, {0, 0}, {width, 0}, cv::Scalar(dark.x(), dark.y(), dark.z()) * 0.45, std::max(1, tall / 48));
    const int joint = random.uniform(0, width);
    cv::line(one, {joint, 0}, {joint, tall}, cv::Scalar(dark.x(), dark.y(), dark.z()) * 0.5, 1);
    one.copyTo(rgb(cv::Rect(0, top, width, tall)));
  }
  return to_texture(rgb);
}

Texture wall_texture(int width, int height, std::uint64_t seed) {
  cv::RNG random(seed + 7);
  cv::Mat rgb(height, width, CV_8UC3, cv::Scalar(196, 186, 168));
  // Light from the window's side falls off along the wall, and a little towards the floor.
  const cv::Mat blotches = smooth_noise(width, height, width / 9.0, height / 5.0, random);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float across = static_cast<float>(x) / static_cast<float>(width);
      const float down = static_cast<float>(y) / static_cast<float>(height);
      const float light = (0.70f + 0.38f * std::exp(-3.f * std::abs(across - 0.32f)) - 0.16f * down) *
                          (0.97f + 0.06f * blotches.at<float>(y, x));
      cv::Vec3b& pixel = rgb.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) pixel[c] = cv::saturate_cast<std::uint8_t>(static_cast<float>(pixel[c]) * light);
    }
  }
  // Window with its frame, sill and a radiator below.
  rectangle(rgb, 0.20, 0.02, 0.42, 0.56, {226, 222, 214});
  rectangle(rgb, 0.21, 0.03, 0.305, 0.54, {232, 240, 246});
  rectangle(rgb, 0.315, 0.03, 0.41, 0.54, {226, 236, 244});
  rectangle(rgb, 0.21, 0.34, 0.305, 0.54, {172, 190, 160});
  rectangle(rgb, 0.315, 0.30, 0.41, 0.54, {160, 180, 150});
  rectangle(rgb, 0.19, 0.56, 0.43, 0.585, {214, 208, 198});
  rectangle(rgb, 0.215, 0.66, 0.405, 0.92, {206, 202, 194});
  for (int rib = 0; rib < 22; ++rib) {
    const double x = 0.22 + rib * 0.0085;
    rectangle(rgb, x, 0.675, x + 0.003, 0.905, {164, 160, 152});
  }
  // Curtains.
  for (int fold = 0; fold < 12; ++fold) {
    const double shade = 0.72 + 0.28 * std::abs(std::sin(fold * 1.7));
    rectangle(rgb, 0.145 + fold * 0.0048, 0.0, 0.151 + fold * 0.0048, 0.93, cv::Scalar(128, 108, 96) * shade);
    rectangle(rgb, 0.425 + fold * 0.0048, 0.0, 0.431 + fold * 0.0048, 0.93, cv::Scalar(122, 102, 92) * shade);
  }
  // Bookcase.
  rectangle(rgb, 0.56, 0.0, 0.80, 0.95, {84, 62, 44});
  for (int shelf = 0; shelf < 5; ++shelf) {
    const double y = 0.01 + shelf * 0.186;
    rectangle(rgb, 0.568, y, 0.792, y + 0.168, {52, 38, 28});
    books(rgb, 0.572, y, 0.788, y + 0.166, random);
  }
  // A picture on the wall, a floor lamp and its glow.
  rectangle(rgb, 0.03, 0.10, 0.115, 0.42, {60, 46, 36});
  rectangle(rgb, 0.037, 0.125, 0.108, 0.395, {150, 160, 150});
  rectangle(rgb, 0.037, 0.28, 0.108, 0.395, {96, 108, 78});
  rectangle(rgb, 0.886, 0.20, 0.892, 0.95, {70, 66, 60});
  rectangle(rgb, 0.862, 0.02, 0.916, 0.22, {246, 224, 176});
  // Skirting board.
  rectangle(rgb, 0.0, 0.935, 0.56, 0.985, {206, 200, 190});
  rectangle(rgb, 0.80, 0.935, 1.0, 0.985, {206, 200, 190});
  rectangle(rgb, 0.0, 0.985, 1.0, 1.0, {60, 48, 38});
  cv::GaussianBlur(rgb, rgb, cv::Size(), width / 400.0);
  return to_texture(rgb);
}

Texture cloth_texture(int width, int height, std::uint64_t seed) {
  cv::RNG random(seed + 3);
  const cv::Mat large = smooth_noise(width, height, width / 6.0, height / 6.0, random);
  const cv::Mat fine = smooth_noise(width, height, 1.5, 1.5, random);
  cv::Mat rgb(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float weave = ((x + y) % 4 < 2 ? 0.94f : 1.f) * (0.86f + 0.14f * fine.at<float>(y, x)) *
                          (0.9f + 0.2f * large.at<float>(y, x));
      rgb.at<cv::Vec3b>(y, x) = cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(215 * weave));
    }
  }
  return to_texture(rgb);
}

}  // namespace counterpart::stage
