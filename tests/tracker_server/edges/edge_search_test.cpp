#include "tracker_server/edges/edge_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace counterpart {
namespace {

// Dark on the left, light on the right of x = edge, the pixel in between mixed as a sensor does.
cv::Mat1b step_picture(double edge) {
  cv::Mat1b picture(40, 60);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) {
      const double covered = std::clamp(x + 0.5 - edge, 0.0, 1.0);
      picture(y, x) = static_cast<std::uint8_t>(std::lround(50 + 150 * covered));
    }
  return picture;
}

EdgeHit find(const cv::Mat1b& picture, const EdgeProbe& probe, float reach = 6) {
  std::array<EdgeHit, 1> hit;
  search_edges(picture, std::array{probe}, {reach, 12}, hit);
  return hit[0];
}

TEST(EdgeSearch, FindsAStepToATenthOfAPixel) {
  for (double edge = 28; edge < 32; edge += 0.23) {
    const EdgeHit hit = find(step_picture(edge), {30, 20, 1, 0, 1});
    ASSERT_EQ(hit.verdict, EdgeVerdict::accepted);
    EXPECT_NEAR(30 + hit.distance, edge, 0.1);
    EXPECT_NEAR(hit.contrast, 150, 20);
  }
}

TEST(EdgeSearch, SaysWhyItRefused) {
  const cv::Mat1b picture = step_picture(30);
  EXPECT_EQ(find(picture, {30, 20, 1, 0, -1}).verdict, EdgeVerdict::low_contrast) << "the other polarity";
  EXPECT_EQ(find(picture, {15, 20, 1, 0, 1}).verdict, EdgeVerdict::low_contrast);
  EXPECT_EQ(find(picture, {2, 20, 1, 0, 1}).verdict, EdgeVerdict::outside);
  EXPECT_EQ(find(picture, {std::numeric_limits<float>::quiet_NaN(), 20, 1, 0, 1}).verdict, EdgeVerdict::outside);
  cv::Mat1b twice = step_picture(27);
  for (int y = 0; y < twice.rows; ++y)
    for (int x = 33; x < twice.cols; ++x) twice(y, x) = static_cast<std::uint8_t>(x < 36 ? 50 : 200);
  EXPECT_EQ(find(twice, {31, 20, 1, 0, 1}, 8).verdict, EdgeVerdict::ambiguous);
}

TEST(EdgeSearch, EitherPolarityWhereNoneIsKnown) {
  const EdgeHit hit = find(step_picture(31), {30, 20, -1, 0, 0});
  EXPECT_EQ(hit.verdict, EdgeVerdict::accepted);
  EXPECT_LT(hit.contrast, 0) << "darker towards the normal";
  EXPECT_NEAR(hit.distance, -1, 0.1);
}

}  // namespace
}  // namespace counterpart
