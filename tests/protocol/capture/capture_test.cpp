#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "protocol/capture/mcap.hpp"
#include "protocol/capture/mcap_writer.hpp"
#include "protocol/capture/recorder.hpp"
#include "protocol/capture/session_reader.hpp"
#include "protocol/codec/codec.hpp"
#include "tests/protocol/samples.hpp"

namespace counterpart {
namespace {

std::string scratch(const std::string& name) {
  return testing::TempDir() + "counterpart_capture_" + name;
}

// A capture of every sample, sent by a tracker.
std::string record_samples(const std::string& name) {
  const std::string path = scratch(name);
  auto recorder = Recorder::open(path, Role::tracker, "test");
  std::int64_t time_ns = 1'000;
  std::uint64_t seq = 0;
  for (const auto& [sample, message] : sample_messages()) {
    const Bytes body = *encode(message);
    Header header;
    header.type = static_cast<std::uint16_t>(type_of(message));
    header.seq = is_kept(type_of(message)) ? ++seq : 0;
    (*recorder)->saw(false, false, 1, seal(header, body), body, time_ns += 1'000'000);
  }
  return path;
}

std::vector<Message> read_all(SessionReader& reader) {
  std::vector<Message> all;
  while (auto recorded = reader.next()) all.push_back(std::move(recorded->message));
  return all;
}

TEST(Capture, GivesBackEveryMessageInOrder) {
  auto reader = SessionReader::open(record_samples("whole.mcap"));
  ASSERT_TRUE(reader);
  const auto all = read_all(**reader);
  const auto samples = sample_messages();
  ASSERT_EQ(all.size(), samples.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_TRUE(all[i] == samples[i].second) << samples[i].first;
  EXPECT_FALSE((*reader)->problem());
  EXPECT_TRUE((*reader)->file().complete());
  EXPECT_EQ((*reader)->file().metadata().at("session").at("role"), "tracker");
}

TEST(Capture, GivesWhatStandsBeforeTheCutAndSaysThatItIsCut) {
  const std::string whole = record_samples("to_cut.mcap");
  const auto size = std::filesystem::file_size(whole);
  const auto samples = sample_messages();
  const std::string cut = scratch("cut.mcap");
  for (std::uintmax_t length = 8; length < size; length += 61) {
    std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, length);
    auto reader = SessionReader::open(cut);
    ASSERT_TRUE(reader);
    const auto all = read_all(**reader);
    ASSERT_LE(all.size(), samples.size());
    for (std::size_t i = 0; i < all.size(); ++i) ASSERT_TRUE(all[i] == samples[i].second);
    EXPECT_TRUE((*reader)->problem()) << length;
    EXPECT_FALSE((*reader)->file().complete());
  }
}

TEST(Capture, PassesOverADamagedChunkAndReadsTheNext) {
  const std::string path = scratch("damaged.mcap");
  auto writer = McapWriter::create(path);
  ASSERT_TRUE(writer);
  const Bytes data{1, 2, 3, 4};
  std::vector<std::uintmax_t> ends;
  for (std::uint64_t i = 0; i < 3; ++i) {
    (*writer)->add((*writer)->channel("/x", "json"), 100 * i, 0, data);
    ASSERT_TRUE((*writer)->write_chunk());
    ends.push_back(std::filesystem::file_size(path));
  }
  ASSERT_TRUE((*writer)->close());
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(ends[0] + 90));
  file.put(0x55);
  file.close();
  auto reader = McapReader::open(path);
  ASSERT_TRUE(reader);
  std::vector<std::uint64_t> times;
  while (const auto message = (*reader)->next()) times.push_back(message->log_ns);
  EXPECT_EQ(times, (std::vector<std::uint64_t>{0, 200}));
  ASSERT_TRUE((*reader)->problem());
  EXPECT_NE((*reader)->problem()->message.find("checksum"), std::string::npos);
}

TEST(Capture, SaysThatTheDiskIsFull) {
  auto writer = McapWriter::create("/dev/full");
  if (writer) {
    (*writer)->add((*writer)->channel("/x", "json"), 1, 1, Bytes{1});
    const auto done = (*writer)->write_chunk();
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message.find("No space left"), std::string::npos);
  } else {
    EXPECT_NE(writer.error().message.find("No space left"), std::string::npos);
  }
}

TEST(Capture, RefusesOtherFiles) {
  EXPECT_EQ(SessionReader::open(scratch("nowhere.mcap")).error().code, ErrorCode::not_found);
  EXPECT_EQ(SessionReader::open(COUNTERPART_SOURCE_DIR "/LICENSE").error().code, ErrorCode::bad_format);
}

// The check value of this CRC (ITU-T V.42).
TEST(Mcap, Crc32GivesThePublishedValue) {
  const std::string text = "123456789";
  EXPECT_EQ(mcap::crc32(ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size())), 0xCBF43926U);
}

}  // namespace
}  // namespace counterpart
