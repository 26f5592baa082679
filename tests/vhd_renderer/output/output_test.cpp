#include "vhd_renderer/output/output.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "vhd_renderer/output/ffmpeg_handles.hpp"

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

// Loudness of a film's sound, by tenth of a second.
std::vector<double> loudness_of(const std::string& file) {
  AVFormatContext* opened = nullptr;
  if (avformat_open_input(&opened, file.c_str(), nullptr, nullptr) < 0) return {};
  avformat_find_stream_info(opened, nullptr);
  const int stream = av_find_best_stream(opened, AVMEDIA_TYPE_AUDIO, -1, -1, nullptr, 0);
  std::vector<double> sums;
  if (stream >= 0) {
    const AVCodecParameters* parameters = opened->streams[stream]->codecpar;
    const std::unique_ptr<AVCodecContext, CodecDeleter> codec(
        avcodec_alloc_context3(avcodec_find_decoder(parameters->codec_id)));
    avcodec_parameters_to_context(codec.get(), parameters);
    avcodec_open2(codec.get(), nullptr, nullptr);
    const std::unique_ptr<AVPacket, PacketDeleter> packet(av_packet_alloc());
    const std::unique_ptr<AVFrame, FrameDeleter> frame(av_frame_alloc());
    while (av_read_frame(opened, packet.get()) >= 0) {
      if (packet->stream_index == stream && avcodec_send_packet(codec.get(), packet.get()) >= 0) {
        while (avcodec_receive_frame(codec.get(), frame.get()) >= 0) {
          for (int i = 0; i < frame->nb_samples; ++i) {
            const double t = (static_cast<double>(frame->pts) + i) / codec->sample_rate;
            const auto tenth = static_cast<std::size_t>(std::max(0.0, 10 * t));
            if (sums.size() <= tenth) sums.resize(tenth + 1, 0.0);
            sums[tenth] += std::abs(reinterpret_cast<const float*>(frame->data[0])[i]) / (0.1 * codec->sample_rate);
          }
        }
      }
      av_packet_unref(packet.get());
    }
  }
  avformat_close_input(&opened);
  return sums;
}

TEST_F(OutputTest, FilmIsHeardWhereSomebodySpeaks) {
  const std::string file = (folder_ / "film.mp4").string();
  auto film = open_output(file, 22050);
  ASSERT_TRUE(film) << film.error().message;
  auto tone = std::make_shared<Sound>();
  for (int i = 0; i < 22050; ++i) tone->samples.push_back(i / 40 % 2 == 0 ? 8000 : -8000);
  // Three seconds; it is spoken from 1 s on and cut short after half a second.
  for (int i = 0; i < 75; ++i) {
    const bool speaks = i >= 25 && i < 37;
    (*film)->hear(speaks ? tone : nullptr, 0.04 * (i - 25));
    ASSERT_TRUE((*film)->write(picture(i % 30), i * 40'000'000LL));
  }
  ASSERT_TRUE((*film)->finish());
  const std::vector<double> loudness = loudness_of(file);
  ASSERT_GE(loudness.size(), 29U) << "sound as long as the film";
  for (std::size_t tenth = 0; tenth < 29; ++tenth) {
    const bool spoken = tenth >= 11 && tenth <= 13;
    const bool silent = tenth <= 8 || tenth >= 16;
    if (spoken) {
      EXPECT_GT(loudness[tenth], 0.1) << tenth;
    } else if (silent) {
      EXPECT_LT(loudness[tenth], 0.01) << tenth;
    }
  }
  cv::VideoCapture read(file);
  cv::Mat bgr;
  int count = 0;
  while (read.read(bgr)) ++count;
  EXPECT_EQ(count, 75);
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
  EXPECT_NE(open_output("/nowhere/at/all/film.mp4").error().message.find("/nowhere/at/all/film.mp4"),
            std::string::npos);
  std::ofstream(folder_ / "file") << "x";
  EXPECT_FALSE(open_output((folder_ / "file" / "sub").string()));
}

}  // namespace
}  // namespace counterpart
