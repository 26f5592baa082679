// The whole system as its users start it: stage, tracker and renderer as processes that share nothing but TCP.
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "tests/support/program.hpp"

namespace counterpart {
namespace {

using testing_support::Outcome;
using testing_support::run;
using testing_support::TemporaryFolder;

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

Outcome play_demo(std::vector<std::string> arguments) {
  const std::string script = std::string(COUNTERPART_SOURCE_DIR) + "/stage/play_demo.py";
  arguments.insert(arguments.begin(), {"python3", script, "--programs", COUNTERPART_BIN_DIR});
  return run("/usr/bin/env", arguments, std::chrono::seconds(400));
}

int frames_in(const std::string& film) {
  cv::VideoCapture capture(film);
  cv::Mat bgr;
  int count = 0;
  while (capture.read(bgr)) ++count;
  return count;
}

// Poses without the column that says how long they took.
std::string poses_without_times(const std::string& file) {
  std::ifstream in(file);
  std::string out;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    int column = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++column) {
      if (column != 11) out += cell + ',';
    }
    out += '\n';
  }
  return out;
}

TEST(Demo, AGameBeginsOnTheStageAndTwoRunsAreTheSame) {
  // 260 frames are 10.4 s: he walks in, sits down, and the first moves of both sides are made.
  const TemporaryFolder first, second;
  for (const TemporaryFolder* folder : {&first, &second}) {
    const Outcome played = play_demo({"--headless", "--frames", "260", "--out", folder->folder()});
    ASSERT_EQ(played.exit_code, 0) << played.err;
  }
  const auto report = nlohmann::json::parse(text_of(first.path("report.json")));
  EXPECT_EQ(report["frames"], 260);
  EXPECT_EQ(report["composited"], 260);
  EXPECT_EQ(report["frames_with_pose"], 260);
  EXPECT_EQ(report["drops"]["camera"], 0);
  EXPECT_EQ(report["drops"]["renderer"], 0);
  // A quarter of a pixel at the board's corners is a millimetre there: virtual pieces stand on their squares.
  EXPECT_LT(report["pose_error"]["corner_px_rms"]["median"], 0.25);
  EXPECT_LT(report["pose_error"]["corner_px_rms"]["max"], 1.0);
  EXPECT_GE(report["moves"].size(), 1u);
  EXPECT_EQ(frames_in(first.path("demo.mp4")), 260);
  EXPECT_NE(text_of(first.path("demo.pdn")).find("[GameType \"20\"]"), std::string::npos);
  EXPECT_FALSE(text_of(first.path("contact-sheet.png")).empty());

  EXPECT_EQ(text_of(first.path("demo.pdn")), text_of(second.path("demo.pdn")));
  EXPECT_EQ(poses_without_times(first.path("poses.csv")), poses_without_times(second.path("poses.csv")));
  EXPECT_TRUE(text_of(first.path("demo.mp4")) == text_of(second.path("demo.mp4"))) << "the films differ";
}

TEST(Demo, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  EXPECT_EQ(play_demo({"--frames", "-3"}).exit_code, 2);
  EXPECT_EQ(play_demo({"--squares", "9"}).exit_code, 2);
  const Outcome missing = play_demo({"--headless", "--camera", "/nowhere/film.mp4", "--out", folder.folder()});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("/nowhere/film.mp4"), std::string::npos) << missing.err;
}

}  // namespace
}  // namespace counterpart
