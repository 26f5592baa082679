// docs/counterpart.lua in tshark: every message type over TCP, in segments that end in the middle of messages.
#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/codec/codec.hpp"
#include "tests/protocol/samples.hpp"
#include "tests/support/program.hpp"

namespace counterpart {
namespace {

using testing_support::run;
using testing_support::TemporaryFolder;

template <class T>
void append_big_endian(Bytes& out, T value) {
  for (int shift = 8 * (static_cast<int>(sizeof value) - 1); shift >= 0; shift -= 8) {
    out.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

// One TCP segment to port 7401 in an IPv4 packet; checksums are not filled in, which tshark does not mind.
Bytes packet(std::uint32_t seq, ByteView payload) {
  Bytes out{0x45, 0};
  append_big_endian(out, static_cast<std::uint16_t>(40 + payload.size()));
  out.insert(out.end(), {0, 0, 0, 0, 64, 6, 0, 0, 10, 0, 0, 1, 10, 0, 0, 2});
  append_big_endian(out, std::uint16_t{40'000});
  append_big_endian(out, std::uint16_t{7401});
  append_big_endian(out, seq);
  append_big_endian(out, std::uint32_t{1});
  out.insert(out.end(), {0x50, 0x18, 0xFF, 0xFF, 0, 0, 0, 0});
  out.insert(out.end(), payload.begin(), payload.end());
  return out;
}

// The classic pcap format, link type 101 (raw IP).
void write_pcap(const std::string& file, const Bytes& stream) {
  constexpr std::size_t kSegment = 1'000;
  Bytes out;
  for (const std::uint32_t word : {0xA1B2C3D4U, 4U << 16 | 2U, 0U, 0U, 65'535U, 101U}) append(out, word);
  for (std::size_t at = 0; at < stream.size(); at += kSegment) {
    const Bytes one = packet(static_cast<std::uint32_t>(1 + at),
                             ByteView(stream).subspan(at, std::min(kSegment, stream.size() - at)));
    const auto size = static_cast<std::uint32_t>(one.size());
    for (const std::uint32_t word : {static_cast<std::uint32_t>(at / kSegment), 0U, size, size}) append(out, word);
    out.insert(out.end(), one.begin(), one.end());
  }
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(out.data()), static_cast<std::streamsize>(out.size()));
}

TEST(Dissector, NamesEveryMessageInTshark) {
  if (run("/usr/bin/env", {"sh", "-c", "command -v tshark"}).exit_code != 0) GTEST_SKIP() << "tshark is not installed";
  const TemporaryFolder folder;
  Bytes stream;
  std::string expected;
  for (const auto& [name, message] : sample_messages()) {
    const auto body = encode(message);
    ASSERT_TRUE(body) << name;
    Header header;
    header.type = static_cast<std::uint16_t>(type_of(message));
    const HeaderBytes head = seal(header, *body);
    stream.insert(stream.end(), head.begin(), head.end());
    stream.insert(stream.end(), body->begin(), body->end());
    expected += std::to_string(header.type) + ' ';
  }
  write_pcap(folder.path("session.pcap"), stream);
  const auto seen = run("/usr/bin/env", {"tshark", "-r", folder.path("session.pcap"), "-X",
                                         "lua_script:" COUNTERPART_SOURCE_DIR "/docs/counterpart.lua", "-Y",
                                         "counterpart", "-T", "fields", "-e", "counterpart.type"});
  ASSERT_EQ(seen.exit_code, 0) << seen.err;
  std::string types;  // by packets, in each with commas between
  for (const char c : seen.out) types += c == ',' || c == '\n' ? ' ' : c;
  EXPECT_EQ(types, expected) << seen.err;
}

}  // namespace
}  // namespace counterpart
