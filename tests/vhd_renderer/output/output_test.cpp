#include "vhd_renderer/output/output.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace counterpart {
namespace {

namespace fs = std::filesystem;

class OutputTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("counterpart_output_" + std::to_string(::getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  // A grey picture with a white bar whose place tells its number.
  static cv::Mat picture(int number, int width = 320, int height = 240) {
    cv::Mat bgr(height, width, CV_8UC3, cv::Scalar(60, 60, 60));
    cv::rectangle(bgr, {number * 10, 0, 10, height}, cv::Scalar(255, 255, 255), cv::FILLED);
    return bgr;
  }

  fs::path folder_;
};

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

TEST_F(OutputTest, FilmHoldsEveryPictureInOrder) {
  const std::string file = (folder_ / "film.mp4").string();
  auto film = open_output(file);
  ASSERT_TRUE(film) << film.error().message;
  for (int i = 0; i < 12; ++i) ASSERT_TRUE((*film)->write(picture(i), i * 40'000'000LL));
  ASSERT_TRUE((*film)->finish());

  cv::VideoCapture read(file);
  ASSERT_TRUE(read.isOpened());
  EXPECT_NEAR(read.get(cv::CAP_PROP_FPS), 25.0, 0.1);
  cv::Mat bgr;
  for (int i = 0; i < 12; ++i) {
    ASSERT_TRUE(read.read(bgr)) << "picture " << i;
    EXPECT_GT(bgr.at<cv::Vec3b>(120, i * 10 + 5)[1], 200) << "picture " << i;
    EXPECT_LT(bgr.at<cv::Vec3b>(120, (i * 10 + 60) % 320)[1], 110) << "picture " << i;
  }
  EXPECT_FALSE(read.read(bgr));
}

TEST_F(OutputTest, FilmIsReadableWhenItsWriterIsKilled) {
  const fs::path file = folder_ / "film.mp4";
  const fs::path cut = folder_ / "cut.mp4";
  auto film = open_output(file.string());
  ASSERT_TRUE(film);
  // More than two groups of pictures: the first ones are on disk before the end.
  for (int i = 0; i < 220; ++i) ASSERT_TRUE((*film)->write(picture(i % 30), i * 40'000'000LL));
  fs::copy_file(file, cut);  // as it would be found after a kill -9 at this moment
  cv::VideoCapture read(cut.string());
  ASSERT_TRUE(read.isOpened());
  cv::Mat bgr;
  int count = 0;
  while (read.read(bgr)) ++count;
  EXPECT_GE(count, 50);
}

TEST_F(OutputTest, TwoFilmsOfTheSamePicturesHaveTheSameBytes) {
  for (const char* name : {"a.mp4", "b.mp4"}) {
    auto film = open_output((folder_ / name).string());
    ASSERT_TRUE(film);
    for (int i = 0; i < 5; ++i) ASSERT_TRUE((*film)->write(picture(i), i * 40'000'000LL));
    ASSERT_TRUE((*film)->finish());
  }
  EXPECT_EQ(bytes_of(folder_ / "a.mp4"), bytes_of(folder_ / "b.mp4"));
}

TEST_F(OutputTest, PictureFolderIsLossless) {
  auto out = open_output((folder_ / "pictures").string());
  ASSERT_TRUE(out);
  ASSERT_TRUE((*out)->write(picture(3), 0));
  const cv::Mat read = cv::imread((folder_ / "pictures/frame_00000.png").string());
  ASSERT_FALSE(read.empty());
  EXPECT_EQ(cv::norm(read, picture(3), cv::NORM_INF), 0);
}

TEST_F(OutputTest, SaysWhatCannotBeWritten) {
  EXPECT_NE(open_output("film.avi").error().message.find(".mp4"), std::string::npos);
  EXPECT_NE(open_output("/nowhere/at/all/film.mp4").error().message.find("/nowhere/at/all/film.mp4"), std::string::npos);
  std::ofstream(folder_ / "file") << "x";
  EXPECT_FALSE(open_output((folder_ / "file" / "sub").string()));
}

}  // namespace
}  // namespace counterpart
