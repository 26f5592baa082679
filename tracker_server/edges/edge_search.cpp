#include "tracker_server/edges/edge_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace counterpart {
namespace {

constexpr int max_reach = 32;
constexpr int half_filter = 2;  // pixels averaged on each side of a step
constexpr int max_profile = 2 * (max_reach + half_filter) + 2;

// A second edge counts as a rival from this share of the best one's worth on, and from this distance on.
constexpr float rival_worth = 0.85F;
constexpr float farther_is_worse = 0.5F;  // of its worth an edge loses so much at the end of the reach
constexpr int rival_distance = 3;

struct Profile {
  std::array<float, max_profile> grey;
  std::array<float, max_profile> step;
};

struct Choice {
  int place = 0;
  EdgeVerdict verdict = EdgeVerdict::low_contrast;
};

// How well a peak fits: the strongest of all, or the one most like what is expected, rather near than far.
float worth_of(float strength, int distance, int reach, float expected) {
  if (!(expected > 0)) return strength;
  const float likeness = std::min(strength, expected) / std::max(strength, expected);
  return likeness * (1 - farther_is_worse * static_cast<float>(distance) / static_cast<float>(reach));
}

// The best peak among profile.step[0..steps).
Choice choose_edge(const Profile& profile, int steps, float min_contrast, float expected) {
  const int reach = steps / 2;
  const auto step = [&](int k) { return profile.step[static_cast<std::size_t>(k)]; };
  const auto worth = [&](int k) {
    const bool peak = step(k) >= min_contrast && step(k) >= step(k - 1) && step(k) >= step(k + 1);
    return peak ? worth_of(step(k), std::abs(k - reach), reach, expected) : 0;
  };
  Choice best{reach, EdgeVerdict::low_contrast};
  float most = 0;
  for (int k = 1; k < steps - 1; ++k) {
    const float value = worth(k);
    if (value <= most) continue;
    most = value;
    best = {k, EdgeVerdict::accepted};
  }
  if (best.verdict != EdgeVerdict::accepted) return best;
  // At either end the true maximum may lie beyond the reach.
  if (!(expected > 0) && std::max(step(0), step(steps - 1)) > step(best.place))
    return {best.place, EdgeVerdict::low_contrast};
  for (int k = 1; k < steps - 1; ++k)
    if (std::abs(k - best.place) >= rival_distance && worth(k) > rival_worth * most)
      return {best.place, EdgeVerdict::ambiguous};
  return best;
}

// Between two pixels, by a parabola through the peak.
float place_of_edge(const Profile& profile, int best) {
  const auto step = [&](int k) { return profile.step[static_cast<std::size_t>(k)]; };
  const float before = step(best - 1), after = step(best + 1);
  const float bend = before - 2 * step(best) + after;
  return static_cast<float>(best) + (bend < -1e-6F ? 0.5F * (before - after) / bend : 0.0F);
}

EdgeHit search_edge(const cv::Mat1b& picture, const EdgeProbe& probe, int reach, float min_contrast, Profile& profile) {
  const int far_end = reach + half_filter;
  const int count = 2 * far_end + 1;
  const float x0 = probe.x - static_cast<float>(far_end) * probe.nx;
  const float y0 = probe.y - static_cast<float>(far_end) * probe.ny;
  const float x1 = probe.x + static_cast<float>(far_end) * probe.nx;
  const float y1 = probe.y + static_cast<float>(far_end) * probe.ny;
  const float right = static_cast<float>(picture.cols) - 1.001F;
  const float bottom = static_cast<float>(picture.rows) - 1.001F;
  // Written so that NaN counts as outside.
  if (!(x0 >= 0 && x0 < right && x1 >= 0 && x1 < right && y0 >= 0 && y0 < bottom && y1 >= 0 && y1 < bottom))
    return {0, 0, 0, EdgeVerdict::outside};

  const std::uint8_t* pixels = picture.data;
  const auto stride = static_cast<std::ptrdiff_t>(picture.step[0]);
  for (int i = 0; i < count; ++i) {
    const float x = x0 + static_cast<float>(i) * probe.nx;
    const float y = y0 + static_cast<float>(i) * probe.ny;
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    const float fx = x - static_cast<float>(column), fy = y - static_cast<float>(row);
    const std::uint8_t* p = pixels + row * stride + column;
    const float top = static_cast<float>(p[0]) + fx * static_cast<float>(p[1] - p[0]);
    const float low = static_cast<float>(p[stride]) + fx * static_cast<float>(p[stride + 1] - p[stride]);
    profile.grey[static_cast<std::size_t>(i)] = top + fy * (low - top);
  }

  // step[k]: mean of the two pixels after minus mean of the two before, k = 0 at distance -reach.
  const int steps = 2 * reach + 1;
  const float sign = probe.polarity < 0 ? -1.0F : 1.0F;
  for (int k = 0; k < steps; ++k) {
    const float* g = profile.grey.data() + k;
    const float value = 0.5F * sign * (g[3] + g[4] - g[0] - g[1]);
    profile.step[static_cast<std::size_t>(k)] = probe.polarity == 0 ? std::abs(value) : value;
  }
  const Choice choice = choose_edge(profile, steps, min_contrast, probe.contrast);
  if (choice.verdict != EdgeVerdict::accepted)
    return {0, profile.step[static_cast<std::size_t>(choice.place)], 0, choice.verdict};
  const int best = choice.place;

  EdgeHit hit;
  hit.distance = place_of_edge(profile, best) - static_cast<float>(reach);
  const float* g = profile.grey.data() + best;
  hit.contrast = 0.5F * (g[3] + g[4] - g[0] - g[1]);
  hit.grey = 0.25F * (g[0] + g[1] + g[3] + g[4]);
  hit.verdict = EdgeVerdict::accepted;
  return hit;
}

}  // namespace

void search_edges(const cv::Mat1b& grey, std::span<const EdgeProbe> probes, const EdgeSearch& search,
                  std::span<EdgeHit> hits) {
  const int reach = std::clamp(static_cast<int>(std::ceil(search.reach)), 2, max_reach);
  Profile profile;
  for (std::size_t i = 0; i < probes.size(); ++i)
    hits[i] = search_edge(grey, probes[i], reach, search.min_contrast, profile);
}

}  // namespace counterpart
