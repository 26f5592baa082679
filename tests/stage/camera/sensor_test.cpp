#include "stage/camera/sensor.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace counterpart::stage {
namespace {

double deviation_at(int grey, double noise) {
  cv::Mat picture(300, 300, CV_8UC3, cv::Scalar::all(grey));
  expose(picture, {0, noise}, 1, 0);
  cv::Scalar mean, deviation;
  cv::meanStdDev(picture, mean, deviation);
  EXPECT_NEAR(mean[0], grey, 0.15);  // noise must not shift the brightness
  return deviation[0];
}

TEST(Sensor, NoiseIsAsLargeAsAskedAtMidGreyAndGrowsWithLight) {
  EXPECT_NEAR(deviation_at(128, 4), 4, 0.2);
  EXPECT_NEAR(deviation_at(128, 2), 2, 0.15);
  EXPECT_LT(deviation_at(40, 4), 0.85 * deviation_at(128, 4));
  EXPECT_GT(deviation_at(220, 4), 1.2 * deviation_at(128, 4));
}

TEST(Sensor, SameSeedAndFrameGiveTheSameBytes) {
  const cv::Mat clean(40, 50, CV_8UC3, cv::Scalar(90, 120, 150));
  cv::Mat a = clean.clone(), b = clean.clone(), c = clean.clone();
  expose(a, {}, 5, 9);
  expose(b, {}, 5, 9);
  expose(c, {}, 5, 10);
  EXPECT_EQ(cv::norm(a, b, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(a, c, cv::NORM_INF), 0);
}

TEST(Sensor, BlurKeepsAnEdgeInItsPlace) {
  cv::Mat picture(20, 40, CV_8UC3, cv::Scalar::all(0));
  picture.colRange(20, 40).setTo(cv::Scalar::all(200));
  expose(picture, {0.8, 0}, 1, 0);
  EXPECT_EQ(picture.at<cv::Vec3b>(10, 19)[0] + picture.at<cv::Vec3b>(10, 20)[0], 200);
}

}  // namespace
}  // namespace counterpart::stage
