#include "tracker_server/edges/pyramid.hpp"

#include <opencv2/imgproc.hpp>

namespace counterpart {

Pyramid build_pyramid(const cv::Mat& picture, int levels) {
  Pyramid pyramid;
  cv::Mat1b grey;
  if (picture.channels() == 3)
    cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  else
    grey = picture.clone();  // a pyramid may be kept for longer than its picture
  pyramid.levels.push_back(grey);
  for (int level = 1; level < levels; ++level) {
    const cv::Mat1b& finer = pyramid.levels.back();
    if (finer.cols < 32 || finer.rows < 32) break;
    // An odd last row or column is left out, so that every pixel is the mean of exactly four.
    const cv::Mat1b even = finer(cv::Rect(0, 0, finer.cols / 2 * 2, finer.rows / 2 * 2));
    cv::Mat1b half;
    cv::resize(even, half, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
    pyramid.levels.push_back(half);
  }
  return pyramid;
}

}  // namespace counterpart
