// The daemons as programs: what they say when something is wrong, and that a game outlives either of them.
#include <csignal>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/network.hpp"
#include "tests/support/program.hpp"

namespace counterpart {
namespace {

using testing_support::free_address;
using testing_support::Outcome;
using testing_support::Program;
using testing_support::run;
using testing_support::TemporaryFolder;

using std::chrono::seconds;

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

TEST(TrackerServer, SaysWhatIsWrongInOneSentence) {
  EXPECT_EQ(run("tracker_server", {"serve"}).exit_code, 2);
  EXPECT_EQ(run("tracker_server", {"serve", "--camera", "x", "--squares", "9"}).exit_code, 2);
  const Outcome missing = run("tracker_server", {"serve", "--camera", "/dev/video97", "--listen", free_address()});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.err.find("/dev/video97"), std::string::npos) << missing.err;
  const Outcome fen =
      run("tracker_server", {"serve", "--camera", "x", "--listen", free_address(), "--fen", "W:W99:B1"});
  EXPECT_EQ(fen.exit_code, 1);
  EXPECT_NE(fen.err.find("99"), std::string::npos) << fen.err;
  const Outcome open = run("tracker_server", {"serve", "--camera", "x", "--listen", "0.0.0.0:0"});
  EXPECT_EQ(open.exit_code, 1);
  EXPECT_NE(open.err.find("token"), std::string::npos) << open.err;
}

TEST(TrackerServer, APortInUseIsNamed) {
  const std::string address = free_address();
  Program stage("stage", {"serve", "--listen", address, "--lockstep"});
  ASSERT_TRUE(stage.wait_for_stderr("vhp://", seconds(30))) << stage.stderr_text();
  const Outcome second = run("tracker_server", {"serve", "--camera", "x", "--listen", address});
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_NE(second.err.find(address.substr(address.find(':') + 1)), std::string::npos) << second.err;
}

TEST(TrackerServer, ABoardThatIsNeverFoundIsAFailure) {
  const TemporaryFolder folder;
  const cv::Mat grey(240, 320, CV_8UC3, cv::Scalar(90, 90, 90));
  for (int i = 0; i < 5; ++i) cv::imwrite(folder.path("frame_0000" + std::to_string(i) + ".png"), grey);
  const Outcome outcome = run("tracker_server", {"serve", "--camera", folder.folder(), "--listen", free_address()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("no board"), std::string::npos) << outcome.err;
}

TEST(TrackerServer, ATruncatedPictureIsNamed) {
  const TemporaryFolder folder;
  std::ofstream(folder.path("frame_00000.png"), std::ios::binary) << "\x89PNG\r\n\x1a\n";
  const Outcome outcome = run("tracker_server", {"serve", "--camera", folder.folder(), "--listen", free_address()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("frame_00000.png"), std::string::npos) << outcome.err;
}

TEST(VhdRenderer, SaysWhatIsWrongInOneSentence) {
  EXPECT_EQ(run("vhd_renderer", {}).exit_code, 2);
  EXPECT_EQ(run("vhd_renderer", {"serve", "--blend", "pink"}).exit_code, 2);
  const std::string nobody = free_address();
  const Outcome alone =
      run("vhd_renderer", {"serve", "--tracker", nobody, "--patience", "0.3", "--character", "mannequin"});
  EXPECT_EQ(alone.exit_code, 1);
  EXPECT_NE(alone.err.find(nobody), std::string::npos) << alone.err;
  const Outcome nowhere = run("vhd_renderer", {"serve", "--tracker", nobody, "--character", "mannequin", "--output",
                                               "/nowhere/film.mp4", "--patience", "0.3"});
  EXPECT_EQ(nowhere.exit_code, 1);
}

TEST(Programs, TellTheirVersionAndHelp) {
  for (const char* program : {"tracker_server", "vhd_renderer", "stage", "vhp", "draughts"}) {
    const Outcome version = run(program, {"--version"});
    EXPECT_EQ(version.exit_code, 0) << program;
    EXPECT_NE(version.out.find("0.1.0"), std::string::npos) << program << ": " << version.out;
    EXPECT_EQ(run(program, {"--help"}).exit_code, 0) << program;
    EXPECT_EQ(run(program, {"--no-such-option"}).exit_code, 2) << program;
  }
}

// A game on the stage with the daemons under this test's control. The mannequin plays: it needs no data and starts at
// once.
class LivingGame : public testing::Test {
 protected:
  void SetUp() override {
    stage_ = std::make_unique<Program>(
        "stage", std::vector<std::string>{"serve", "--listen", stage_address_, "--lockstep", "--scenario",
                                          std::string(COUNTERPART_SOURCE_DIR) + "/stage/scenarios/demo.json"});
    ASSERT_TRUE(stage_->wait_for_stderr("vhp://", seconds(30))) << stage_->stderr_text();
  }

  std::unique_ptr<Program> start_tracker() const {
    return std::make_unique<Program>(
        "tracker_server",
        std::vector<std::string>{"serve", "--camera", "vhp://" + stage_address_, "--listen", tracker_address_,
                                 "--lockstep", "--state", folder_.path("state"), "--pdn", folder_.path("game.pdn")});
  }

  std::unique_ptr<Program> start_renderer() const {
    return std::make_unique<Program>(
        "vhd_renderer",
        std::vector<std::string>{"serve", "--tracker", tracker_address_, "--lockstep", "--character", "mannequin"});
  }

  // Moves of the game kept so far.
  std::vector<std::string> moves() const {
    const auto state = nlohmann::json::parse(text_of(folder_.path("state/game.json")), nullptr, false);
    const auto* found = find(state, "moves");
    return found == nullptr ? std::vector<std::string>{} : found->get<std::vector<std::string>>();
  }

  bool wait_for_moves(std::size_t count, seconds at_most) const {
    const auto end = std::chrono::steady_clock::now() + at_most;
    while (moves().size() < count && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return moves().size() >= count;
  }

  static const nlohmann::json* find(const nlohmann::json& json, const std::string& key) {
    if (json.is_object() && json.contains(key)) return &json[key];
    if (!json.is_structured()) return nullptr;
    for (const auto& child : json) {
      if (const auto* found = find(child, key)) return found;
    }
    return nullptr;
  }

  TemporaryFolder folder_;
  std::string stage_address_ = free_address();
  std::string tracker_address_ = free_address();
  std::unique_ptr<Program> stage_;
};

TEST_F(LivingGame, GoesOnWhenEitherDaemonIsKilledAndStartedAgain) {
  auto tracker = start_tracker();
  auto renderer = start_renderer();
  ASSERT_TRUE(wait_for_moves(1, seconds(90))) << tracker->stderr_text() << renderer->stderr_text();

  renderer->send_signal(SIGKILL);
  renderer->wait(seconds(5));
  renderer = start_renderer();
  const std::size_t before = moves().size();
  ASSERT_TRUE(wait_for_moves(before + 2, seconds(120))) << tracker->stderr_text() << renderer->stderr_text();

  tracker->send_signal(SIGKILL);
  tracker->wait(seconds(5));
  const auto kept = moves();
  tracker = start_tracker();
  ASSERT_TRUE(wait_for_moves(kept.size() + 2, seconds(120))) << tracker->stderr_text() << renderer->stderr_text();
  const auto now = moves();
  EXPECT_TRUE(std::equal(kept.begin(), kept.end(), now.begin())) << "the game was not gone on with but begun anew";

  // Ctrl-C ends both cleanly.
  tracker->send_signal(SIGINT);
  EXPECT_EQ(tracker->wait(seconds(10)), 0) << tracker->stderr_text();
  EXPECT_EQ(renderer->wait(seconds(10)), 0)
      << "the renderer ends when the tracker says goodbye: " << renderer->stderr_text();
}

}  // namespace
}  // namespace counterpart
