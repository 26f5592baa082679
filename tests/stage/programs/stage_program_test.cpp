#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/program.hpp"

namespace counterpart {
namespace {

using testing_support::Outcome;
using testing_support::run;
using testing_support::TemporaryFolder;

const std::string kPlain = COUNTERPART_SOURCE_DIR "/stage/scenarios/plain.json";

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(StageProgram, RendersASequenceThatCanBeReadBack) {
  const TemporaryFolder folder;
  const Outcome outcome = run("stage", {"render", kPlain, "--out", folder.path("film"), "--frames", "3"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.empty());
  const cv::Mat frame = cv::imread(folder.path("film/frame_00002.png"));
  EXPECT_EQ(frame.size(), cv::Size(720, 576));
  EXPECT_FALSE(std::filesystem::exists(folder.path("film/frame_00003.png")));
  for (const char* name : {"camera.json", "init.json", "poses.csv", "truth.jsonl"}) {
    EXPECT_FALSE(content(folder.path(std::string("film/") + name)).empty()) << name;
  }
  const std::string poses = content(folder.path("film/poses.csv"));
  EXPECT_EQ(std::count(poses.begin(), poses.end(), '\n'), 4);
  EXPECT_EQ(poses.rfind("frame,tx,ty,tz,qw,qx,qy,qz\n", 0), 0u);

  const Outcome again = run("stage", {"render", kPlain, "--out", folder.path("film")});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_NE(again.err.find("holds a sequence already"), std::string::npos) << again.err;
}

TEST(StageProgram, SaysWhatIsWrongWithItsArguments) {
  EXPECT_EQ(run("stage", {}).exit_code, 2);
  EXPECT_EQ(run("stage", {"render", kPlain}).exit_code, 2);
  EXPECT_EQ(run("stage", {"serve", "--frames", "some"}).exit_code, 2);
  EXPECT_EQ(run("stage", {"--help"}).exit_code, 0);
  EXPECT_EQ(run("stage", {"--version"}).exit_code, 0);
  const Outcome missing = run("stage", {"render", "/nowhere.json", "--out", "/tmp"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("/nowhere.json"), std::string::npos) << missing.err;
}

TEST(StageProgram, SaysWhenAPortIsInUseOrCannotBe) {
  const Outcome bad = run("stage", {"serve", "--listen", "127.0.0.1:99999"});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_NE(bad.err.find("99999"), std::string::npos) << bad.err;
}

}  // namespace
}  // namespace counterpart
