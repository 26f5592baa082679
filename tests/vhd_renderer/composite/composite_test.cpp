#include "vhd_renderer/composite/composite.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace counterpart {
namespace {

const cv::Scalar kGrey(100, 120, 140);

// 8x8; left half drawn in red, column 5 in shadow by a half.
RenderedFrame half_red() {
  cv::Mat bgra(8, 8, CV_8UC4, cv::Scalar(0, 0, 0, 0));
  bgra(cv::Rect(0, 0, 4, 8)).setTo(cv::Scalar(0, 0, 200, 255));
  bgra(cv::Rect(5, 0, 1, 8)).setTo(cv::Scalar(0, 0, 0, 127));
  return split_drawing(bgra, cv::Rect(0, 0, 8, 8));
}

CompositeOptions sharp() {
  CompositeOptions options;
  options.blur_px = 0;
  return options;
}

TEST(Composite, PutsDrawnOverRealAndDarkensShadowsExactly) {
  const cv::Mat frame(8, 8, CV_8UC3, kGrey);
  const cv::Mat out = composite(frame, half_red(), nullptr, sharp());
  EXPECT_EQ(out.at<cv::Vec3b>(3, 1), cv::Vec3b(0, 0, 200));
  EXPECT_EQ(out.at<cv::Vec3b>(3, 4), cv::Vec3b(100, 120, 140));
  EXPECT_EQ(out.at<cv::Vec3b>(3, 5), cv::Vec3b(50, 60, 70));  // 128/255 of the camera's
  EXPECT_EQ(frame.at<cv::Vec3b>(3, 1), cv::Vec3b(100, 120, 140)) << "the camera's picture must not change";
}

TEST(Composite, BlackKeyIsThePapersAndKnowsNoShadows) {
  CompositeOptions options;
  options.blend = Blend::black_key;
  const cv::Mat out = composite(cv::Mat(8, 8, CV_8UC3, kGrey), half_red(), nullptr, options);
  EXPECT_EQ(out.at<cv::Vec3b>(3, 3), cv::Vec3b(0, 0, 200));
  EXPECT_EQ(out.at<cv::Vec3b>(3, 4), cv::Vec3b(100, 120, 140));
  EXPECT_EQ(out.at<cv::Vec3b>(3, 5), cv::Vec3b(100, 120, 140));
}

TEST(Composite, ARealHandStaysInFront) {
  Mask mask;
  mask.width = 8;
  mask.height = 8;
  mask.runs = {16, 2, 46};  // the first two pixels of row 2
  const cv::Mat out = composite(cv::Mat(8, 8, CV_8UC3, kGrey), half_red(), &mask, sharp());
  EXPECT_EQ(out.at<cv::Vec3b>(2, 0), cv::Vec3b(100, 120, 140));
  EXPECT_EQ(out.at<cv::Vec3b>(2, 2), cv::Vec3b(0, 0, 200));
}

TEST(Composite, SoftEdgesLieBetweenTheTwoPictures) {
  CompositeOptions options;
  options.blur_px = 1;
  const cv::Mat out = composite(cv::Mat(8, 8, CV_8UC3, kGrey), half_red(), nullptr, options);
  const cv::Vec3b edge = out.at<cv::Vec3b>(3, 3);
  EXPECT_GT(edge[0], 10);
  EXPECT_LT(edge[0], 90);
  EXPECT_GT(edge[2], 140);  // between 140 and 200, never darker than both: no dark fringe
}

TEST(Composite, GrainIsTheSeedsAndStaysOnWhatIsDrawn) {
  CompositeOptions options = sharp();
  options.noise = 5;
  options.seed = 7;
  const cv::Mat frame(8, 8, CV_8UC3, kGrey);
  const cv::Mat a = composite(frame, half_red(), nullptr, options);
  EXPECT_EQ(cv::norm(a, composite(frame, half_red(), nullptr, options), cv::NORM_INF), 0);
  EXPECT_EQ(a.at<cv::Vec3b>(3, 4), cv::Vec3b(100, 120, 140));
  options.seed = 8;
  EXPECT_GT(cv::norm(a, composite(frame, half_red(), nullptr, options), cv::NORM_INF), 0);
}

TEST(Composite, MasksThatDoNotAddUpAreLeftOut) {
  Mask mask;
  mask.width = 8;
  mask.height = 8;
  mask.runs = {10, 4000000000u};
  EXPECT_TRUE(mask_picture(mask).empty());
  mask.runs = {10};
  EXPECT_TRUE(mask_picture(mask).empty());
}

}  // namespace
}  // namespace counterpart
