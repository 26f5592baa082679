// Commands while the link, the tracker or the renderer is killed again and again.
#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <memory>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "tests/protocol/robustness/scale.hpp"
#include "tests/support/network.hpp"
#include "tests/support/program.hpp"
#include "tests/support/relay.hpp"

namespace counterpart {
namespace {

using testing_support::free_address;
using testing_support::Program;
using testing_support::TemporaryFolder;

std::map<std::string, int> lines_of(const std::string& path) {
  std::map<std::string, int> lines;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) ++lines[line];
  return lines;
}

TEST(Kills, NoCommandIsLostOrCarriedOutTwice) {
  const int commands = scaled(1'000, 10'000);
  const int kills = scaled(20, 200);
  const TemporaryFolder folder;
  const std::string asked = folder.path("asked"), done = folder.path("done");
  const std::string address = free_address();
  Relay relay(static_cast<std::uint16_t>(std::stoi(address.substr(address.find(':') + 1))));
  const auto start_tracker = [&] {
    return std::make_unique<Program>("link_worker",
                                     std::vector<std::string>{"tracker", address, asked, std::to_string(commands)});
  };
  const auto start_renderer = [&] {
    return std::make_unique<Program>("link_worker", std::vector<std::string>{"renderer", relay.address(), done});
  };
  auto tracker = start_tracker();
  auto renderer = start_renderer();
  std::mt19937 random(7);
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(scaled(90, 800));
  for (int kill = 0; kill < kills; ++kill) {
    // Spread over the whole of the work, and at any moment of it.
    const auto due =
        static_cast<std::size_t>(commands) * static_cast<std::size_t>(kill) / static_cast<std::size_t>(kills);
    while (lines_of(done).size() < due && std::chrono::steady_clock::now() < give_up) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 3'000));
    switch (kill % 3) {
      case 0:
        relay.cut();
        break;
      case 1:
        tracker.reset();  // SIGKILL
        tracker = start_tracker();
        break;
      default:
        renderer.reset();
        renderer = start_renderer();
    }
  }
  EXPECT_EQ(tracker->wait(std::chrono::seconds(60)), 0) << tracker->stderr_text();
  renderer.reset();
  const auto all_asked = lines_of(asked), all_done = lines_of(done);
  EXPECT_EQ(all_asked.size(), static_cast<std::size_t>(commands));
  EXPECT_EQ(all_done.size(), static_cast<std::size_t>(commands)) << "a line that begins with \"twice\" is one too many";
  for (const auto& [line, times] : all_done) EXPECT_EQ(times, 1) << line;
}

}  // namespace
}  // namespace counterpart
