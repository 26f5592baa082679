#include "protocol/framing/frame_parser.hpp"

#include <random>

#include <gtest/gtest.h>

#include "protocol/codec/codec.hpp"
#include "tests/protocol/samples.hpp"

namespace counterpart {
namespace {

struct Stream {
  Bytes bytes;
  std::vector<Bytes> bodies;
};

Stream sample_stream() {
  Stream stream;
  for (const auto& [name, message] : sample_messages()) {
    const Bytes body = *encode(message);
    Header header;
    header.type = static_cast<std::uint16_t>(type_of(message));
    const HeaderBytes sealed = seal(header, body);
    stream.bytes.insert(stream.bytes.end(), sealed.begin(), sealed.end());
    stream.bytes.insert(stream.bytes.end(), body.begin(), body.end());
    stream.bodies.push_back(body);
  }
  return stream;
}

// Everything that the parser finds in these pieces; nothing after the first failure.
std::vector<Bytes> bodies_in(const std::vector<ByteView>& pieces, bool& failed) {
  FrameParser parser;
  std::vector<Bytes> bodies;
  failed = false;
  for (ByteView piece : pieces) {
    while (!piece.empty() && !failed) {
      piece = piece.subspan(parser.feed(piece));
      while (true) {
        auto message = parser.next();
        failed = !message;
        if (failed || !*message) break;
        bodies.push_back((*message)->body);
      }
    }
  }
  return bodies;
}

TEST(FrameParser, FindsTheSameMessagesWhereverTheStreamIsCut) {
  const Stream stream = sample_stream();
  const ByteView all(stream.bytes);
  bool failed = false;
  for (std::size_t cut = 0; cut <= all.size(); ++cut) {
    ASSERT_EQ(bodies_in({all.first(cut), all.subspan(cut)}, failed), stream.bodies) << cut;
    ASSERT_FALSE(failed);
  }
  std::vector<ByteView> single;
  for (std::size_t i = 0; i < all.size(); ++i) single.push_back(all.subspan(i, 1));
  EXPECT_EQ(bodies_in(single, failed), stream.bodies);
}

TEST(FrameParser, NoFlippedBitGoesUnnoticed) {
  Stream stream = sample_stream();
  std::mt19937 random(1);
  for (std::size_t byte = 0; byte < stream.bytes.size(); ++byte) {
    const auto bit = static_cast<std::uint8_t>(1U << (random() % 8));
    stream.bytes[byte] ^= bit;
    bool failed = false;
    const auto found = bodies_in({stream.bytes}, failed);
    // Either it is noticed, or (a changed length) the parser still waits for the rest: never a changed message.
    ASSERT_LT(found.size(), stream.bodies.size()) << byte;
    for (std::size_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i], stream.bodies[i]);
    stream.bytes[byte] ^= bit;
  }
}

TEST(FrameParser, RefusesALengthAboveTheLimitBeforeTakingMemory) {
  for (const auto& [type, limit] :
       {std::pair{MessageType::video, 16U << 20}, std::pair{MessageType::command, 64U << 10},
        std::pair{static_cast<MessageType>(999), 64U << 10}}) {
    Header header;
    header.type = static_cast<std::uint16_t>(type);
    HeaderBytes bytes = seal(header, {});
    store(bytes.data() + 8, limit);
    FrameParser parser;
    parser.feed(bytes);
    EXPECT_TRUE(parser.next()) << "the limit itself is permitted";
    store(bytes.data() + 8, limit + 1);
    FrameParser other;
    other.feed(bytes);
    const auto refused = other.next();
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::limit_exceeded);
  }
}

TEST(FrameParser, StaysFailed) {
  FrameParser parser;
  const std::string text = "GET / HTTP/1.1\r\nHost: somewhere\r\nAccept: everything\r\n\r\n";
  parser.feed(ByteView(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
  ASSERT_FALSE(parser.next());
  const Stream good = sample_stream();
  parser.feed(good.bytes);
  EXPECT_FALSE(parser.next()) << "no guessing where the next message begins";
}

TEST(FrameParser, CarriesAPictureLargerThanItsBuffer) {
  Bytes body(5'000'000);
  for (std::size_t i = 0; i < body.size(); ++i) body[i] = static_cast<std::uint8_t>(i * 7);
  Header header;
  header.type = static_cast<std::uint16_t>(MessageType::video);
  const HeaderBytes sealed = seal(header, body);
  bool failed = false;
  EXPECT_EQ(bodies_in({sealed, ByteView(body).first(100'001), ByteView(body).subspan(100'001), sealed, body}, failed),
            (std::vector<Bytes>{body, body}));
  EXPECT_FALSE(failed);
}

}  // namespace
}  // namespace counterpart
