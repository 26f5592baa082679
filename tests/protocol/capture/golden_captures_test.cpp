// Captures of version 1, kept for ever: what this program writes must stay readable by old ones, and the other way
// round.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/capture/checkup.hpp"
#include "protocol/capture/mcap_writer.hpp"
#include "protocol/capture/session_reader.hpp"
#include "protocol/capture/wire_record.hpp"
#include "protocol/capture/wire_writer.hpp"

namespace counterpart {
namespace {

const std::string kData = COUNTERPART_SOURCE_DIR "/tests/data/";
const std::string kWhole = kData + "captures/v1_every_message.mcap";
const std::string kKilled = kData + "captures/v1_killed.mcap";  // the same, cut off inside its last chunk

Bytes bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// The exact bytes of one message of every type.
std::vector<std::pair<std::string, Bytes>> golden_messages() {
  std::vector<std::pair<std::string, Bytes>> messages;
  std::ifstream in(kData + "protocol_v1.txt");
  for (std::string name, hex; in >> name >> hex;) {
    Bytes bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    }
    messages.emplace_back(name, bytes);
  }
  return messages;
}

Bytes as_record(const Bytes& message) {
  HeaderBytes header{};
  std::copy_n(message.begin(), header.size(), header.begin());
  Bytes record;
  append_wire_record(record, false, false, 1, header, ByteView(message).subspan(kHeaderSize));
  return record;
}

// How kWhole was written.
std::string write_again() {
  const std::string path = testing::TempDir() + "counterpart_v1_every_message.mcap";
  auto writer = McapWriter::create(path);
  EXPECT_TRUE((*writer)->write_metadata("session", {{"role", "tracker"}, {"software", "version 1"}}));
  std::int64_t time_ns = 0;
  for (const auto& [name, message] : golden_messages()) {
    EXPECT_TRUE(add_wire_record(**writer, as_record(message), time_ns += 1'000'000));
    if ((*writer)->chunk_bytes() < 2'000) continue;
    EXPECT_TRUE((*writer)->write_chunk());
  }
  EXPECT_TRUE((*writer)->close());
  return path;
}

// The header record names the version of the library, and every place in the file moves with its length.
std::size_t after_header(const Bytes& file) {
  return 8 + 9 + load<std::uint64_t>(file.data() + 9);
}

TEST(GoldenCaptures, AreReadMessageByMessage) {
  auto reader = McapReader::open(kWhole);
  ASSERT_TRUE(reader) << reader.error().message;
  const auto expected = golden_messages();
  std::size_t at = 0;
  while (const auto entry = (*reader)->next()) {
    if (entry->topic != "/wire") continue;
    ASSERT_LT(at, expected.size());
    EXPECT_EQ(entry->data, as_record(expected[at].second)) << expected[at].first;
    EXPECT_EQ(entry->log_ns, 1'000'000 * (at + 1));
    ++at;
  }
  EXPECT_EQ(at, expected.size());
  EXPECT_TRUE((*reader)->complete());
  EXPECT_EQ((*reader)->metadata().at("session").at("role"), "tracker");
  auto session = SessionReader::open(kWhole);
  std::size_t understood = 0;
  while ((*session)->next()) ++understood;
  EXPECT_EQ(understood, expected.size());
}

TEST(GoldenCaptures, AreWhatIsWrittenToday) {
  const Bytes now = bytes_of(write_again()), then = bytes_of(kWhole);
  ASSERT_GT(then.size(), 1'000U);
  if (after_header(now) != after_header(then)) GTEST_SKIP() << "the version's name has another length";
  const auto rest = [](const Bytes& file) { return Bytes(file.begin() + after_header(file), file.end()); };
  EXPECT_TRUE(rest(now) == rest(then)) << "captures are written in another way: old programs have to read them";
}

TEST(GoldenCaptures, WhatAKilledProgramLeftIsRecovered) {
  const std::string saved = testing::TempDir() + "counterpart_v1_recovered.mcap";
  const auto recovery = recover_capture(kKilled, saved);
  ASSERT_TRUE(recovery) << recovery.error().message;
  EXPECT_GT(recovery->messages, 10U);
  EXPECT_LT(recovery->messages, golden_messages().size());
  EXPECT_FALSE(recovery->problem.empty());
  auto reader = McapReader::open(saved);
  ASSERT_TRUE(reader);
  const auto expected = golden_messages();
  std::size_t at = 0;
  while (const auto entry = (*reader)->next()) {
    if (entry->topic != "/wire") continue;
    EXPECT_EQ(entry->data, as_record(expected[at++].second));
  }
  EXPECT_EQ(at, recovery->messages);
}

}  // namespace
}  // namespace counterpart
