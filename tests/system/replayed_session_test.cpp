// A whole game on two hosts is captured on both; each capture then plays the other side to a fresh program, which must
// do the same again. Needs root. He begins with few virtual pieces, with one more
// under COUNTERPART_LONG=1.
#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/protocol/robustness/scale.hpp"
#include "tests/support/network.hpp"
#include "tests/support/on_two_hosts.hpp"

namespace counterpart {
namespace {

using namespace testing_support;

// Frames; in both the game is over some seconds before.
constexpr int kShort = 360, kLong = 700;

constexpr char kOnePiece[] = "B:W18:B1,2,3,4,5,6,7,8,9,10,11,12";      // both sides capture
constexpr char kTwoPieces[] = "B:W22,23:B1,2,3,4,5,6,7,8,9,10,11,12";  // four moves of each side

const seconds kPatience{scaled(400, 800)};

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

// What was said in messages of this type, in order.
Words said(const std::string& capture, const std::string& type) {
  std::istringstream lines(run("vhp", {"capture", "cat", capture, "--type", type}).out);
  Words bodies;
  for (std::string line; std::getline(lines, line);) {
    bodies.push_back(nlohmann::json::parse(line).at("body").dump());
  }
  return bodies;
}

class ReplayedSession : public OnTwoHosts {
 protected:
  void SetUp() override {
    OnTwoHosts::SetUp();
    if (IsSkipped()) return;
    write_private("small.json", R"({"name": "small", "seed": 3, "frames": 100000,
                                    "camera": {"width": 360, "height": 288, "focal_px": 305},
                                    "board": {"squares": 8}, "player": {"speed": 5}})");
    for (const Words& words : {Words{"link", "add", "far0", "netns", hosts_.tracker_host(), "type", "veth", "peer",
                                     "name", "far0", "netns", hosts_.renderer_host()},
                               Words{"-n", hosts_.tracker_host(), "address", "add", "10.99.8.1/24", "dev", "far0"},
                               Words{"-n", hosts_.renderer_host(), "address", "add", "10.99.8.2/24", "dev", "far0"},
                               Words{"-n", hosts_.tracker_host(), "link", "set", "far0", "up"},
                               Words{"-n", hosts_.tracker_host(), "link", "set", "lo", "up"},
                               Words{"-n", hosts_.renderer_host(), "link", "set", "far0", "up"}}) {
      const Outcome done = ip(words);
      if (done.exit_code != 0) GTEST_SKIP() << "two namespaces cannot be joined here: " << done.err;
    }
    ASSERT_NO_FATAL_FAILURE(play());
  }

  // Stage and tracker on one host, the renderer on the other.
  void play() const {
    const std::string link = "10.99.8.1:7401", camera = "127.0.0.1:7403";
    Program stage("/sbin/ip", TwoNameSpaces::on(hosts_.tracker_host(), "stage",
                                                {"serve", "--listen", camera, "--lockstep", "--scenario",
                                                 folder_.path("small.json")}));
    ASSERT_TRUE(stage.wait_for_stderr("vhp://", seconds(60))) << stage.stderr_text();
    Program tracker("/sbin/ip", TwoNameSpaces::on(
                                    hosts_.tracker_host(), "tracker_server",
                                    tracker_words("vhp://" + camera, link, "tracker.mcap", {"--token-file", token()})));
    Program renderer(
        "/sbin/ip",
        TwoNameSpaces::on(
            hosts_.renderer_host(), "vhd_renderer",
            renderer_words(link, "film.mp4", {"--token-file", token(), "--record", folder_.path("renderer.mcap")})));
    ASSERT_EQ(tracker.wait(kPatience), 0) << tracker.stderr_text() << renderer.stderr_text();
    ASSERT_EQ(renderer.wait(seconds(60)), 0) << renderer.stderr_text();
  }

  Words tracker_words(const std::string& camera, const std::string& listen, const std::string& record,
                      const Words& more) const {
    Words words{"serve",     "--camera",
                camera,      "--listen",
                listen,      "--lockstep",
                "--video",   "raw",
                "--level",   "1",
                "--squares", "8",
                "--rules",   "english",
                "--fen",     scaled(kOnePiece, kTwoPieces),
                "--frames",  std::to_string(scaled(kShort, kLong)),
                "--record",  folder_.path(record)};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  Words renderer_words(const std::string& tracker, const std::string& film, const Words& more) const {
    Words words{"serve",    "--tracker",        tracker,      "--lockstep", "--character", "mannequin",
                "--output", folder_.path(film), "--patience", "60"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
};

TEST_F(ReplayedSession, MakesTheSameFilmAndTheSameCommandsAgain) {
  const std::string address = free_address();
  {
    Program tracker("vhp",
                    {"replay", folder_.path("renderer.mcap"), "--as", "tracker", "--listen", address, "--lockstep"});
    const Outcome renderer = run("vhd_renderer", renderer_words(address, "again.mp4", {}), kPatience);
    EXPECT_EQ(renderer.exit_code, 0) << renderer.err;
    EXPECT_EQ(tracker.wait(seconds(20)), 0) << tracker.stderr_text();
  }
  EXPECT_GT(bytes_of(folder_.path("film.mp4")).size(), 10'000U);
  EXPECT_TRUE(bytes_of(folder_.path("film.mp4")) == bytes_of(folder_.path("again.mp4"))) << "the films differ";

  const std::string capture = folder_.path("tracker.mcap"), camera_address = free_address(), link = free_address();
  {
    Program camera("vhp", {"replay", capture, "--as", "camera", "--listen", camera_address, "--lockstep"});
    Program tracker("tracker_server", tracker_words("vhp://" + camera_address, link, "again.mcap", {}));
    Program renderer("vhp", {"replay", capture, "--as", "renderer", "--connect", link, "--lockstep"});
    EXPECT_EQ(tracker.wait(kPatience), 0) << tracker.stderr_text() << camera.stderr_text() << renderer.stderr_text();
  }
  const Words commands = said(capture, "command");
  EXPECT_GE(commands.size(), 3U) << "he came in, sat down and moved";
  EXPECT_EQ(said(folder_.path("again.mcap"), "command"), commands);
  const Words events = said(capture, "game_event");
  EXPECT_EQ(said(folder_.path("again.mcap"), "game_event"), events);
  const auto is_the_end = [](const std::string& event) {
    return nlohmann::json::parse(event).at("kind") == "game_over";
  };
  EXPECT_TRUE(std::any_of(events.begin(), events.end(), is_the_end)) << "the game is not over: it needs more frames";
}

}  // namespace
}  // namespace counterpart
