#include "tracker_server/locate/saddles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

namespace counterpart {
namespace {

constexpr int difference_step = 2;  // pixels, of the second differences
constexpr float ring_radius = 5;    // pixels
constexpr int ring_samples = 32;
constexpr int margin = 8;
constexpr float half_turn = std::numbers::pi_v<float>;

// Minus the determinant of the Hessian: large where the surface is a saddle.
cv::Mat1f saddle_response(const cv::Mat1f& smooth) {
  cv::Mat1f response(smooth.size(), 0.0F);
  for (int y = margin; y < smooth.rows - margin; ++y) {
    const float* above = smooth.ptr<float>(y - difference_step);
    const float* here = smooth.ptr<float>(y);
    const float* below = smooth.ptr<float>(y + difference_step);
    float* out = response.ptr<float>(y);
    for (int x = margin; x < smooth.cols - margin; ++x) {
      const float xx = here[x - difference_step] + here[x + difference_step] - 2 * here[x];
      const float yy = above[x] + below[x] - 2 * here[x];
      const float xy = 0.25F * (above[x - difference_step] + below[x + difference_step] - above[x + difference_step] -
                                below[x - difference_step]);
      out[x] = xy * xy - xx * yy;
    }
  }
  return response;
}

float bilinear(const cv::Mat1f& picture, float x, float y) {
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const float fx = x - static_cast<float>(column), fy = y - static_cast<float>(row);
  const float* p = picture.ptr<float>(row) + column;
  const float* q = picture.ptr<float>(row + 1) + column;
  return (1 - fy) * (p[0] + fx * (p[1] - p[0])) + fy * (q[0] + fx * (q[1] - q[0]));
}

// The stationary point of the quadratic surface round (x, y); false if it lies elsewhere.
bool refine(const cv::Mat1f& smooth, int x, int y, cv::Point2f& p) {
  const auto at = [&](int dx, int dy) { return smooth(y + dy * difference_step, x + dx * difference_step); };
  const float gx = 0.5F * (at(1, 0) - at(-1, 0)), gy = 0.5F * (at(0, 1) - at(0, -1));
  const float xx = at(1, 0) + at(-1, 0) - 2 * at(0, 0), yy = at(0, 1) + at(0, -1) - 2 * at(0, 0);
  const float xy = 0.25F * (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1));
  const float det = xx * yy - xy * xy;
  if (!(det < 0)) return false;
  const float dx = -(yy * gx - xy * gy) / det, dy = -(xx * gy - xy * gx) / det;
  if (std::abs(dx) > 1 || std::abs(dy) > 1) return false;
  p = {static_cast<float>(x) + dx * difference_step, static_cast<float>(y) + dy * difference_step};
  return true;
}

// Looks at a ring round the point: exactly light, dark, light, dark, opposite sectors alike.
bool read_ring(const cv::Mat1f& smooth, Saddle& saddle, float min_strength) {
  std::array<float, ring_samples> ring;
  float mean = 0;
  for (int i = 0; i < ring_samples; ++i) {
    const float angle = 2 * half_turn * static_cast<float>(i) / ring_samples;
    ring[static_cast<std::size_t>(i)] =
        bilinear(smooth, saddle.p.x + ring_radius * std::cos(angle), saddle.p.y + ring_radius * std::sin(angle));
  }
  const auto [low, high] = std::minmax_element(ring.begin(), ring.end());
  if (*high - *low < min_strength) return false;
  mean = 0.5F * (*high + *low);

  std::array<float, 4> rising_or_falling{};
  std::array<bool, 4> rising{};
  int changes = 0;
  for (int i = 0; i < ring_samples; ++i) {
    const float a = ring[static_cast<std::size_t>(i)] - mean;
    const float b = ring[static_cast<std::size_t>((i + 1) % ring_samples)] - mean;
    if ((a < 0) == (b < 0)) continue;
    if (changes == 4) return false;
    const auto slot = static_cast<std::size_t>(changes++);
    rising_or_falling[slot] = 2 * half_turn * (static_cast<float>(i) + a / (a - b)) / ring_samples;
    rising[slot] = b >= 0;
  }
  if (changes != 4) return false;

  // Opposite transitions lie on one straight edge; 0.6 rad leaves room for perspective and for a piece close by.
  const auto straight = [&](std::size_t i) {
    return std::abs(rising_or_falling[i + 2] - rising_or_falling[i] - half_turn) < 0.6F;
  };
  if (!straight(0) || !straight(1)) return false;
  const auto mean_direction = [&](std::size_t i) {
    return std::fmod(0.5F * (rising_or_falling[i] + rising_or_falling[i + 2] - half_turn) + 2 * half_turn, half_turn);
  };
  const std::size_t into_light = rising[0] ? 0 : 1;
  saddle.edge[0] = mean_direction(into_light);
  saddle.edge[1] = mean_direction(1 - into_light);
  const float between = std::fmod(saddle.edge[1] - saddle.edge[0] + 2 * half_turn, half_turn);
  if (between < 0.25F || between > half_turn - 0.25F) return false;

  // The weaker of the two contrasts across the centre, so that an edge with a spot beside it does not pass.
  float light = 255, dark = 0;
  for (int sector = 0; sector < 2; ++sector) {
    const float light_axis = saddle.edge[0] + 0.5F * between + static_cast<float>(sector) * half_turn;
    const float dark_axis = light_axis + 0.5F * half_turn;
    const auto look = [&](float angle) {
      return bilinear(smooth, saddle.p.x + ring_radius * std::cos(angle), saddle.p.y + ring_radius * std::sin(angle));
    };
    light = std::min(light, look(light_axis));
    dark = std::max(dark, look(dark_axis));
  }
  saddle.strength = light - dark;
  return saddle.strength >= 0.5F * min_strength;
}

}  // namespace

std::vector<Saddle> find_saddles(const cv::Mat1b& grey, float min_strength, std::size_t limit) {
  std::vector<Saddle> saddles;
  if (grey.cols < 4 * margin || grey.rows < 4 * margin) return saddles;
  cv::Mat1f smooth;
  grey.convertTo(smooth, CV_32F);
  cv::GaussianBlur(smooth, smooth, cv::Size(0, 0), 1.2);
  const cv::Mat1f response = saddle_response(smooth);
  cv::Mat1f highest;
  cv::dilate(response, highest, cv::Mat(), cv::Point(-1, -1), 2);

  // A corner between squares that differ by s has a response of about (0.3 s)^2 at this scale.
  const float threshold = 0.04F * min_strength * min_strength;
  for (int y = margin; y < grey.rows - margin; ++y) {
    const float* value = response.ptr<float>(y);
    const float* peak = highest.ptr<float>(y);
    for (int x = margin; x < grey.cols - margin; ++x) {
      if (value[x] < threshold || value[x] < peak[x]) continue;
      Saddle saddle;
      if (!refine(smooth, x, y, saddle.p)) continue;
      const float room = ring_radius + 1;
      if (saddle.p.x < room || saddle.p.y < room || saddle.p.x > static_cast<float>(grey.cols) - 1 - room ||
          saddle.p.y > static_cast<float>(grey.rows) - 1 - room)
        continue;
      if (read_ring(smooth, saddle, min_strength)) saddles.push_back(saddle);
    }
  }
  std::sort(saddles.begin(), saddles.end(), [](const Saddle& a, const Saddle& b) {
    if (a.strength != b.strength) return a.strength > b.strength;
    return a.p.y != b.p.y ? a.p.y < b.p.y : a.p.x < b.p.x;
  });
  if (saddles.size() > limit) saddles.resize(limit);
  return saddles;
}

}  // namespace counterpart
