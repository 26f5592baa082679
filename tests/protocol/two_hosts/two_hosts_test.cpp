// Two network namespaces with a bad line between them, and a clock on one that is 1000 s ahead. Needs root.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/protocol/robustness/scale.hpp"
#include "tests/support/on_two_hosts.hpp"

namespace counterpart {
namespace {

using namespace testing_support;

constexpr const char* kAddress = "10.99.7.1:7401";
constexpr int kAheadS = 1000;

struct LineOptions {
  double delay_ms = 20, jitter_ms = 0, loss = 0, reorder = 0;
  double mbit_per_s = 0;  // 0: no limit
};

class TwoHosts : public OnTwoHosts {
 protected:
  void SetUp() override {
    OnTwoHosts::SetUp();
    if (!IsSkipped() && !std::filesystem::exists("/dev/net/tun")) GTEST_SKIP() << "/dev/net/tun is missing";
  }

  void connect(const LineOptions& options) {
    line_ = std::make_unique<Program>(
        "impaired_link",
        Words{tracker_host_, renderer_host_, std::to_string(options.delay_ms), std::to_string(options.jitter_ms),
              std::to_string(options.loss), std::to_string(options.reorder), "7", std::to_string(options.mbit_per_s)});
    ASSERT_TRUE(line_->wait_for_stderr("ready", seconds(10))) << line_->stderr_text();
    const Words mine{"10.99.7.1", "10.99.7.2"};
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string host = i == 0 ? tracker_host_ : renderer_host_;
      ASSERT_EQ(ip({"-n", host, "address", "add", mine[i], "peer", mine[1 - i], "dev", "far0"}).exit_code, 0);
      ASSERT_EQ(ip({"-n", host, "link", "set", "far0", "up"}).exit_code, 0);
    }
  }

  // What the renderer says it saw of so many frames.
  nlohmann::json play(int frames, int per_second, const std::string& video = "raw") {
    const std::string bin = COUNTERPART_BIN_DIR "/far_worker";
    Program tracker("/sbin/ip", {"netns", "exec", tracker_host_, "unshare", "--time", "--monotonic",
                                 std::to_string(kAheadS), "--fork", bin, "tracker", kAddress, token(),
                                 std::to_string(frames), std::to_string(per_second), video});
    const Outcome renderer = run(
        "/sbin/ip",
        {"netns", "exec", renderer_host_, bin, "renderer", kAddress, token(), std::to_string(kAheadS) + "000000000"},
        seconds(60 + 2 * frames / per_second));
    EXPECT_EQ(renderer.exit_code, 0) << renderer.err << tracker.stderr_text();
    std::cout << "  " << renderer.out;
    return nlohmann::json::parse(renderer.out, nullptr, false);
  }

  const std::string tracker_host_ = hosts_.tracker_host(), renderer_host_ = hosts_.renderer_host();
  std::unique_ptr<Program> line_;
};

TEST_F(TwoHosts, NoFrameMeetsAnothersPose) {
  ASSERT_NO_FATAL_FAILURE(connect({20, 0, 0.01, 0.02}));
  const int frames = scaled(1'500, 100'000);
  const auto seen = play(frames, 500);
  ASSERT_TRUE(seen.is_object());
  EXPECT_EQ(seen["wrong"], 0);
  EXPECT_GE(seen["composited"].get<int>(), frames / 20) << "too few to say anything";
}

// 25 pictures a second of a good JPEG need 20 Mbit/s. Half of them must be shown however busy the machine is; a link
// that held its pictures back showed one in thirty.
TEST_F(TwoHosts, ASlowLinkShowsSmallerPicturesEachWithItsPose) {
  for (const std::string video : {"jpeg", "auto"}) {
    ASSERT_NO_FATAL_FAILURE(connect({10, 0, 0, 0, 8}));
    const int frames = scaled(150, 1'500);
    const auto seen = play(frames, 25, video);
    ASSERT_TRUE(seen.is_object());
    EXPECT_LE(seen["bytes_a_picture"].get<int>(), 60'000);
    EXPECT_EQ(seen["wrong"], 0);
    EXPECT_GE(seen["composited"].get<int>(), frames / 2);
    line_.reset();
  }
}

// A mobile line: where pictures that build on each other are lost, those after them must not be shown.
TEST_F(TwoHosts, OnAVerySlowLinkThatLosesMuchEachPictureStillHasItsPose) {
  ASSERT_NO_FATAL_FAILURE(connect({30, 5, 0.02, 0, 3}));
  const int frames = scaled(250, 1'500);
  const auto seen = play(frames, 25, "auto");
  ASSERT_TRUE(seen.is_object());
  EXPECT_EQ(seen["wrong"], 0);
  EXPECT_GE(seen["composited"].get<int>(), frames / 3);
}

// How close the offset comes depends on the machine's load and is only told; its bound must hold whatever the load.
TEST_F(TwoHosts, TheClockOffsetIsInsideItsBound) {
  for (const double jitter_ms : {0.0, 10.0}) {
    ASSERT_NO_FATAL_FAILURE(connect({20, jitter_ms, 0, 0}));
    const auto seen = play(scaled(100, 1'200), 20);
    ASSERT_TRUE(seen.is_object());
    EXPECT_GE(seen["clock_looks"].get<int>(), 30);
    EXPECT_GE(seen["clock_inside_bound"].get<double>(), 0.99 * seen["clock_looks"].get<double>());
    line_.reset();
  }
}

}  // namespace
}  // namespace counterpart
