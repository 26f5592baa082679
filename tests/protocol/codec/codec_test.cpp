#include "protocol/codec/codec.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "protocol/codec/crc32c.hpp"
#include "protocol/codec/json.hpp"
#include "protocol/codec/names.hpp"
#include "tests/protocol/samples.hpp"

namespace counterpart {
namespace {

std::string hex(ByteView bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

Bytes from_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

// The bytes of version 1 as they were when it was fixed. Lines may be added, never changed: old peers and old captures
// speak like this.
std::map<std::string, Bytes> golden() {
  std::map<std::string, Bytes> lines;
  // The second file: what came later and an old program passes over, or never gets.
  for (const char* file : {"/tests/data/protocol_v1.txt", "/tests/data/protocol_v1_added.txt"}) {
    std::ifstream in(COUNTERPART_SOURCE_DIR + std::string(file));
    std::string name, text;
    while (in >> name >> text) lines[name] = from_hex(text);
  }
  return lines;
}

Bytes whole(const Message& message) {
  const auto body = encode(message);
  if (!body) return {};
  Header header;
  header.type = static_cast<std::uint16_t>(type_of(message));
  header.flags = is_kept(type_of(message)) ? kFlagKept : 0;
  header.session = 0x0102030405060708;
  header.seq = is_kept(type_of(message)) ? 17 : 0;
  header.frame_id = frame_of(message);
  header.time_ns = 1'000'000'007;
  const HeaderBytes sealed = seal(header, *body);
  Bytes bytes(sealed.begin(), sealed.end());
  bytes.insert(bytes.end(), body->begin(), body->end());
  return bytes;
}

TEST(Codec, WritesTheGoldenBytesOfVersion1) {
  const auto lines = golden();
  for (const auto& [name, message] : sample_messages()) {
    ASSERT_EQ(lines.count(name), 1U) << "add this line:\n" << name << ' ' << hex(whole(message));
    EXPECT_EQ(hex(lines.at(name)), hex(whole(message))) << name;
  }
}

TEST(Codec, ReadsTheGoldenBytesOfVersion1) {
  const auto lines = golden();
  std::set<MessageType> seen;
  for (const auto& [name, message] : sample_messages()) {
    const Bytes& bytes = lines.at(name);
    const ByteView view(bytes);
    const auto header = read_header(view.first<kHeaderSize>());
    ASSERT_TRUE(header) << name;
    EXPECT_TRUE(crc_matches(view.first<kHeaderSize>(), view.subspan(kHeaderSize))) << name;
    const auto decoded = decode(static_cast<MessageType>(header->type), view.subspan(kHeaderSize));
    ASSERT_TRUE(decoded) << name << ": " << decoded.error().message;
    EXPECT_TRUE(*decoded == message) << name;
    seen.insert(type_of(message));
  }
  EXPECT_EQ(seen.size(), 22U) << "every type has a sample";
}

TEST(Codec, ReadsWhatALaterVersionMadeLonger) {
  for (const auto& [name, message] : sample_messages()) {
    Bytes body = *encode(message);
    if (is_json(type_of(message))) {
      body.pop_back();
      const std::string more = R"(,"a_later_key":{"x":[1,2,null]}})";
      body.insert(body.end(), more.begin(), more.end());
    } else {
      body.insert(body.end(), {1, 2, 3, 4});
    }
    const auto decoded = decode(type_of(message), body);
    ASSERT_TRUE(decoded) << name << ": " << decoded.error().message;
    EXPECT_TRUE(*decoded == message) << name;
  }
}

TEST(Codec, RefusesEveryShortenedBody) {
  for (const auto& [name, message] : sample_messages()) {
    const Bytes body = *encode(message);
    for (std::size_t size = 0; size < body.size(); ++size) {
      EXPECT_FALSE(decode(type_of(message), ByteView(body).first(size))) << name << " cut to " << size;
    }
  }
}

TEST(Codec, NeverSendsNorReadsWhatIsNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  PoseEstimate pose;
  pose.X_CB.p[1] = nan;
  EXPECT_FALSE(encode(pose));
  pose.X_CB.p[1] = 0;
  pose.covariance[20] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(encode(pose));
  pose.covariance[20] = 0;
  Bytes body = *encode(pose);
  store(body.data() + 80, nan);
  EXPECT_FALSE(decode(MessageType::pose, body));
  Intrinsics intrinsics{1, 720, 576, 700, 700, nan, 288, {}};
  EXPECT_FALSE(encode(intrinsics));
  Feedback feedback;
  feedback.gap_mm = nan;
  EXPECT_FALSE(encode(feedback));
  EXPECT_FALSE(from_json_text<Intrinsics>(R"({"width":1,"height":1,"fx":1e999,"fy":1,"cx":0,"cy":0})"));
}

TEST(Codec, SaysWhichKeyIsWrong) {
  const auto problem = [](const char* text) {
    const auto command = from_json_text<Command>(text);
    return command ? std::string("fine") : command.error().message;
  };
  EXPECT_EQ(problem(R"({"id":1,"verb":"say","text":"x"})"), "fine");
  EXPECT_EQ(problem(R"({"id":1,"verb":"say"})"), "command.text is missing");
  EXPECT_EQ(problem(R"({"id":-1,"verb":"say","text":"x"})"), "command.id is out of range");
  EXPECT_EQ(problem(R"({"id":1.5,"verb":"say","text":"x"})"), "command.id must be a whole number");
  EXPECT_EQ(problem(R"({"id":1,"verb":"fly"})"),
            "command.verb must be one of grasp, keyframe, navigate, gaze, say, express, stop");
  EXPECT_EQ(problem(R"({"id":1,"verb":"grasp","path_b":[[0,0]]})"), "command.path_b must be a list of 3");
  EXPECT_EQ(problem(R"({"id":1,"verb":"grasp","path_b":[]})"), "command.path_b must have at least one point");
  EXPECT_EQ(problem(R"({"id":1,"verb":"keyframe","clip":"nod","weight":1.5})"), "command.weight is out of range");
  EXPECT_EQ(problem(R"({"id":1,"verb":"gaze","target":"moon"})"),
            "command.target must be one of square, piece, player, camera, point, ahead");
  EXPECT_EQ(problem("[]"), "command must be a JSON object");
  EXPECT_EQ(problem("{"), "command is not JSON");
  EXPECT_EQ(problem(std::string(60000, '[').c_str()), "command is not JSON");
}

TEST(Codec, RefusesPicturesAndMasksThatDoNotFitTheirSize) {
  VideoFrame video;
  video.width = 4;
  video.height = 4;
  video.stride = 11;
  video.bytes.resize(44);
  EXPECT_FALSE(encode(video)) << "rows overlap";
  video.stride = 12;
  EXPECT_FALSE(encode(video)) << "too few bytes";
  video.bytes.resize(48);
  EXPECT_TRUE(encode(video));
  video.codec = static_cast<PixelCodec>(9);
  EXPECT_FALSE(encode(video));
  Mask mask;
  mask.width = 4;
  mask.height = 4;
  mask.runs = {15};
  EXPECT_FALSE(encode(mask));
  mask.runs = {4294967295U, 17};
  EXPECT_FALSE(encode(mask)) << "sums must not wrap";
}

// RFC 3720, appendix B.4.
TEST(Crc32c, GivesThePublishedValuesBothWays) {
  const Bytes zeros(32, 0), ones(32, 0xFF);
  Bytes rising(32);
  for (std::size_t i = 0; i < 32; ++i) rising[i] = static_cast<std::uint8_t>(i);
  for (const auto crc : {&crc32c, &crc32c_by_table}) {
    EXPECT_EQ(crc(zeros, 0), 0x8A9136AAU);
    EXPECT_EQ(crc(ones, 0), 0x62A8AB43U);
    EXPECT_EQ(crc(rising, 0), 0x46DD794EU);
    for (std::size_t cut = 0; cut <= 32; ++cut) {
      EXPECT_EQ(crc(ByteView(rising).subspan(cut), crc(ByteView(rising).first(cut), 0)), 0x46DD794EU);
    }
  }
}

// Large bodies are read in stripes; the plain table is the other opinion.
TEST(Crc32c, LargeBodiesGiveTheSameInStripesAndByTable) {
  std::mt19937 random(3);
  Bytes bytes(20'000);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  for (std::size_t size = 3'000; size < bytes.size(); size += 511) {
    const ByteView part = ByteView(bytes).subspan(size % 7, size - 7);
    EXPECT_EQ(crc32c(part, 77), crc32c_by_table(part, 77)) << size;
  }
}

TEST(Names, EveryNameLeadsBackToItsValue) {
  for (int value = 1; value <= 13; ++value) {
    const auto kind = static_cast<EventKind>(value);
    EXPECT_EQ(from_name<EventKind>(name_of(kind)), kind);
  }
  EXPECT_FALSE(from_name<Side>("red"));
  EXPECT_EQ(name_of(static_cast<Side>(7)), "");
}

}  // namespace
}  // namespace counterpart
