// `vhd_renderer play` as its user runs it.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "tests/support/program.hpp"

namespace {

using counterpart::testing_support::Outcome;
using counterpart::testing_support::run;
using counterpart::testing_support::TemporaryFolder;

constexpr const char* move_script =
    R"({"at_ms": 0, "scene": {"revision": 1, "pieces": [{"name": "light_1", "side": "light", "p_b": [0.02, -0.06, 0]}]}}
{"at_ms": 0, "id": 1, "verb": "navigate", "place": "seat", "gait": "instant"}
{"at_ms": 0, "id": 2, "verb": "grasp", "piece": "light_1", "path_b": [[-0.02, -0.02, 0]], "hand": "right", "after": [1]}
)";

constexpr double piece_radius_m = 0.016;
constexpr double piece_height_m = 0.008;

void write(const std::string& file, const std::string& text) {
  std::ofstream(file) << text;
}

TEST(Play, MakesAFilmInWhichSomebodySits) {
  const TemporaryFolder folder;
  write(folder.path("s.vhp"), move_script);
  const Outcome played = run("vhd_renderer", {"play", folder.path("s.vhp"), "--opponent", "mannequin", "--size",
                                              "160x128", "--out", folder.path("film.mp4"), "--seconds", "1"});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  cv::VideoCapture film(folder.path("film.mp4"));
  ASSERT_TRUE(film.isOpened());
  cv::Mat picture;
  int frames = 0;
  cv::Mat last;
  while (film.read(picture)) {
    ++frames;
    last = picture.clone();
  }
  EXPECT_EQ(frames, 25);
  EXPECT_EQ(last.size(), cv::Size(160, 128));
  // The wall behind him is of one colour a row; where he sits it is not.
  cv::Scalar mean, spread;
  cv::meanStdDev(last.rowRange(20, 60), mean, spread);
  EXPECT_GT(spread[0], 12) << "there is somebody before the wall";
}

TEST(Play, DrawsIntoTheGivenPicturesWhereTheirPoseIsKnown) {
  const TemporaryFolder folder;
  write(folder.path("s.vhp"), move_script);
  const cv::Mat green(128, 160, CV_8UC3, cv::Scalar(40, 160, 40));
  for (const char* name : {"frame_00000.png", "frame_00001.png"}) cv::imwrite(folder.path(name), green);
  write(folder.path("camera.json"),
        R"({"width": 160, "height": 128, "fx": 140, "fy": 140, "cx": 79.5, "cy": 63.5, "dist": [0, 0, 0, 0, 0]})");
  // From the real player's chair, looking down at the board and across it; the second picture has no pose.
  write(folder.path("poses.csv"),
        "frame,tx,ty,tz,qw,qx,qy,qz,status\n0,0,0.05,1.0,0,0,0.8660254,-0.5,ok\n1,,,,,,,,lost\n");
  const Outcome played = run("vhd_renderer", {"play", folder.path("s.vhp"), "--opponent", "mannequin", "--background",
                                              folder.folder(), "--out", folder.path("out"), "--seconds", "0.08"});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  const cv::Mat drawn = cv::imread(folder.path("out/frame_00000.png"));
  const cv::Mat left_alone = cv::imread(folder.path("out/frame_00001.png"));
  ASSERT_FALSE(drawn.empty());
  ASSERT_FALSE(left_alone.empty());
  EXPECT_GT(cv::norm(drawn, green, cv::NORM_INF), 60) << "somebody is in the picture whose pose is known";
  EXPECT_EQ(cv::norm(left_alone, green, cv::NORM_INF), 0) << "and nobody in the other";
}

TEST(Play, TracesJointsAndPiecesAndAnswersEveryCommand) {
  const TemporaryFolder folder;
  write(folder.path("s.vhp"), move_script);
  const Outcome played =
      run("vhd_renderer", {"play", folder.path("s.vhp"), "--opponent", "mannequin", "--trace", folder.path("t.jsonl")});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  EXPECT_NE(played.out.find(R"("command_id":2)"), std::string::npos);
  EXPECT_NE(played.out.find(R"("state":"finished")"), std::string::npos);
  std::ifstream trace(folder.path("t.jsonl"));
  nlohmann::json last;
  // While the piece is in the air, the skin of each finger that carries it lies on its rim, and in nobody's piece.
  int carried = 0;
  for (std::string line; std::getline(trace, line);) {
    last = nlohmann::json::parse(line);
    const auto& piece = last["pieces"][0];
    if (piece["z"] < 0.01) continue;
    ++carried;
    for (const char* finger : {"r_thumb", "r_index", "r_middle"}) {
      double nearest_m = 1;
      for (const auto& p : last["fingertips"][finger]) {
        const double out =
            std::hypot(p[0].get<double>() - piece["x"].get<double>(), p[1].get<double>() - piece["y"].get<double>()) -
            piece_radius_m;
        const double over = p[2].get<double>() - piece["z"].get<double>();
        if (over > 0 && over < piece_height_m) nearest_m = std::min(nearest_m, out);
      }
      EXPECT_NEAR(nearest_m, 0, 0.001) << finger << " at " << last["t"];
    }
  }
  EXPECT_GT(carried, 5);
  ASSERT_EQ(last["pieces"].size(), 1U);
  EXPECT_NEAR(last["pieces"][0]["x"].get<double>(), -0.02, 1e-4);
  EXPECT_NEAR(last["pieces"][0]["y"].get<double>(), -0.02, 1e-4);
  EXPECT_GT(last["joints"].size(), 40U);
}

TEST(Play, SaysWhatIsWrong) {
  const TemporaryFolder folder;
  write(folder.path("s.vhp"), move_script);
  write(folder.path("bad.vhp"), "{\"at_ms\": 0, \"id\": 1, \"verb\": \"fly\"}\n");
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"play", folder.path("none.vhp")}, "none.vhp"},
      {{"play", folder.path("bad.vhp")}, "line 1"},
      {{"play", folder.path("s.vhp"), "--opponent", "nobody"}, "nobody"},
      {{"play", folder.path("s.vhp"), "--opponent", "mannequin", "--out", folder.path("x.avi")}, ".mp4"},
      {{"play", folder.path("s.vhp"), "--opponent", "mannequin", "--out", folder.path("o"), "--background", "/nowhere"},
       "camera.json"},
      {{"play", folder.path("s.vhp"), "--opponent", "mannequin", "--out", folder.path("o"), "--size", "9"}, "--size"}};
  for (const auto& [arguments, word] : wrong) {
    const Outcome outcome = run("vhd_renderer", arguments);
    EXPECT_NE(outcome.exit_code, 0) << word;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  }
}

}  // namespace
