// Captures whose writer is killed at any moment.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/capture/checkup.hpp"
#include "protocol/capture/mcap.hpp"
#include "protocol/capture/session_reader.hpp"
#include "protocol/transport/monotonic_clock.hpp"
#include "tests/protocol/robustness/scale.hpp"
#include "tests/support/program.hpp"

namespace counterpart {
namespace {

using testing_support::Program;
using testing_support::TemporaryFolder;

// Messages in chunks that are wholly in the file, counted without the reader that is judged. Chunks are not compressed;
// of a command there are two messages, one on /wire and one on /out/command.
std::uint64_t commands_in_whole_chunks(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const Bytes file(std::istreambuf_iterator<char>(in), {});
  const auto count_records = [](ByteView records, std::uint8_t op) {
    std::uint64_t count = 0;
    for (std::size_t at = 0; at + 9 <= records.size(); at += 9 + load<std::uint64_t>(records.data() + at + 1)) {
      count += records[at] == op ? 1 : 0;
    }
    return count;
  };
  std::uint64_t messages = 0;
  for (std::size_t at = 8; at + 9 <= file.size();) {
    const auto length = load<std::uint64_t>(file.data() + at + 1);
    if (length > file.size() - at - 9) break;
    constexpr std::size_t kChunkHead = 8 + 8 + 8 + 4 + 4 + 8;
    if (file[at] == static_cast<std::uint8_t>(mcap::Op::chunk)) {
      messages += count_records(ByteView(file).subspan(at + 9 + kChunkHead, length - kChunkHead),
                                static_cast<std::uint8_t>(mcap::Op::message));
    }
    at += 9 + length;
  }
  return messages / 2;
}

TEST(KilledCaptures, EveryWholeChunkIsRecovered) {
  const int kills = scaled(8, 200);
  const TemporaryFolder folder;
  std::mt19937 random(11);
  std::vector<double> lost_ms;
  for (int kill = 0; kill < kills; ++kill) {
    const std::string path = folder.path("killed.mcap"), saved = folder.path("saved.mcap");
    auto recorder = std::make_unique<Program>("link_worker", std::vector<std::string>{"recorder", path});
    ASSERT_TRUE(recorder->wait_for_stderr("recording", std::chrono::seconds(20)));
    std::this_thread::sleep_for(std::chrono::milliseconds(250 + random() % 400));
    const std::int64_t killed_ns = monotonic_ns();
    recorder.reset();  // SIGKILL
    const auto recovery = recover_capture(path, saved);
    ASSERT_TRUE(recovery) << recovery.error().message;
    EXPECT_GE(recovery->messages, commands_in_whole_chunks(path));
    EXPECT_GE(recovery->messages, 1U);
    auto reader = SessionReader::open(saved);
    ASSERT_TRUE(reader);
    std::uint64_t expected = 0;
    std::int64_t last_ns = 0;
    while (const auto recorded = (*reader)->next()) {
      ASSERT_EQ(std::get<Command>(recorded->message).id, ++expected);
      last_ns = recorded->log_ns;
    }
    EXPECT_EQ(expected, recovery->messages);
    lost_ms.push_back(static_cast<double>(killed_ns - last_ns) / 1e6);
  }
  std::sort(lost_ms.begin(), lost_ms.end());
  std::cout << "  lost by a kill: median " << lost_ms[lost_ms.size() / 2] << " ms, most " << lost_ms.back()
            << " ms, of " << lost_ms.size() << '\n';
}

}  // namespace
}  // namespace counterpart
