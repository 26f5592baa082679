#include "tracker_server/camera/camera.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tracker_server/camera/camera_json.hpp"

namespace counterpart {
namespace {

namespace fs = std::filesystem;

class CameraTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("counterpart_camera_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void add_picture(const std::string& name, int grey) const {
    cv::imwrite((folder_ / name).string(), cv::Mat(20, 30, CV_8UC3, cv::Scalar::all(grey)));
  }
  fs::path folder_;
};

TEST_F(CameraTest, AFolderGivesItsPicturesInNameOrder) {
  add_picture("frame_00001.png", 20);
  add_picture("frame_00000.png", 10);
  add_picture("frame_00002.jpg", 30);
  std::ofstream(folder_ / "camera.json") << R"({"width":30,"height":20,"fx":25,"fy":26,"cx":14.5,"cy":9.5})";
  auto camera = open_camera(folder_.string(), Pace::lockstep);
  ASSERT_TRUE(camera) << camera.error().message;
  ASSERT_TRUE((*camera)->intrinsics());
  EXPECT_EQ((*camera)->intrinsics()->fy, 26);
  for (int i = 0; i < 3; ++i) {
    auto frame = (*camera)->next();
    ASSERT_TRUE(frame && *frame);
    EXPECT_EQ((*frame)->stamp.frame_id, static_cast<FrameId>(i));
    EXPECT_EQ((*frame)->stamp.capture_ns, i * 1'000'000'000LL / 15);  // a folder passes for 15 pictures a second
    EXPECT_NEAR((*frame)->image_bgr.at<cv::Vec3b>(5, 5)[0], 10 * (i + 1), 2);
  }
  auto end = (*camera)->next();
  ASSERT_TRUE(end);
  EXPECT_FALSE(*end);
}

TEST_F(CameraTest, ACutOffPictureIsNamed) {
  add_picture("a.png", 1);
  fs::resize_file(folder_ / "a.png", 20);
  auto camera = open_camera(folder_.string(), Pace::lockstep);
  ASSERT_TRUE(camera);
  const auto frame = (*camera)->next();
  ASSERT_FALSE(frame);
  EXPECT_NE(frame.error().message.find("a.png"), std::string::npos);
}

TEST_F(CameraTest, WhatIsMissingIsSaid) {
  EXPECT_EQ(open_camera("/dev/video99", Pace::lockstep).error().code, ErrorCode::not_found);
  EXPECT_EQ(open_camera("", Pace::lockstep).error().code, ErrorCode::invalid_argument);
  EXPECT_EQ(open_camera(folder_.string(), Pace::lockstep).error().code, ErrorCode::not_found) << "no pictures in it";
  std::ofstream(folder_ / "film.mp4") << "this is no film";
  EXPECT_EQ(open_camera((folder_ / "film.mp4").string(), Pace::lockstep).error().code, ErrorCode::bad_format);
}

TEST_F(CameraTest, NumbersThatAreNoCameraAreRefused) {
  const auto read = [&](const std::string& text) {
    std::ofstream(folder_ / "camera.json") << text;
    return read_camera_json(folder_ / "camera.json");
  };
  EXPECT_FALSE(read("{"));
  EXPECT_FALSE(read("[]"));
  EXPECT_FALSE(read(R"({"width":30,"height":20,"fx":null,"fy":26,"cx":14.5,"cy":9.5})"));
  EXPECT_FALSE(read(R"({"width":30,"height":20,"fx":-3,"fy":26,"cx":14.5,"cy":9.5})"));
  EXPECT_FALSE(read(R"({"width":30,"height":20,"fx":NaN,"fy":26,"cx":14.5,"cy":9.5})"));
  EXPECT_FALSE(read(R"({"width":1e9,"height":20,"fx":3,"fy":26,"cx":14.5,"cy":9.5})"));
  EXPECT_FALSE(read(R"({"width":30,"height":20,"fx":3,"fy":26,"cx":14.5,"cy":9.5,"dist":[1,2,3,4,5,6]})"));
}

TEST_F(CameraTest, InRealTimeTheNewestFrameWins) {
  for (int i = 0; i < 8; ++i) add_picture("frame_0000" + std::to_string(i) + ".png", i);
  auto camera = open_camera(folder_.string(), Pace::realtime);
  ASSERT_TRUE(camera);
  std::uint64_t seen = 0;
  FrameId last = 0;
  while (true) {
    auto frame = (*camera)->next();
    ASSERT_TRUE(frame);
    if (!*frame) break;
    EXPECT_TRUE(seen == 0 || (*frame)->stamp.frame_id > last);
    last = (*frame)->stamp.frame_id;
    ++seen;
  }
  EXPECT_EQ(last, 7U);
  EXPECT_EQ(seen + (*camera)->dropped(), 8U);
}

}  // namespace
}  // namespace counterpart
