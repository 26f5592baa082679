#include "protocol/session/hub.hpp"

#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "protocol/codec/codec.hpp"
#include "protocol/transport/outgoing.hpp"

namespace counterpart {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// Two hubs, a wire and a clock that belong to the test.
class World {
 public:
  explicit World(LinkOptions server_options = {}, LinkOptions client_options = {}, const std::string& server_token = "",
                 const std::string& client_token = "")
      : server(Hub::End::server, tracker(server_options), server_token),
        client(Hub::End::client, client_options, client_token) {}

  void run(std::int64_t ms) {
    for (std::int64_t i = 0; i < ms; ++i) {
      now += kMs;
      server.tick(now);
      client.tick(now);
      while (const auto lane = client.wants_to_dial(now)) {
        const auto accepted = connected ? server.accepted(now) : std::nullopt;
        if (accepted) {
          wires.push_back({*accepted, client.dialled(*lane, now)});
        } else {
          client.dial_failed(*lane, {ErrorCode::unavailable, "no way"}, now);
        }
      }
      carry();
    }
  }

  // Both directions, at most `budget` bytes at a time.
  void carry() {
    for (Wire& wire : wires) {
      move(server, wire.server, client, wire.client, wire.down);
      move(client, wire.client, server, wire.server, wire.up);
    }
    std::vector<Wire> kept;
    for (const Wire& wire : wires) {
      const bool server_done = server.finished(wire.server), client_done = client.finished(wire.client);
      if (server_done || !deaf) close_if(server_done || client_done, server, wire.server);
      if (client_done || !deaf) close_if(server_done || client_done, client, wire.client);
      if (server.exists(wire.server) || client.exists(wire.client)) kept.push_back(wire);
    }
    wires = kept;
  }

  // Everything that is on its way is lost, in the middle of a message if it comes so.
  void cut() {
    for (const Wire& wire : wires) close(wire);
    wires.clear();
  }

  void send(Hub& hub, const Message& message) { hub.broadcast(*make_outgoing(message, {}), now); }

  template <class T>
  std::vector<T> received(Hub& hub) {
    std::vector<T> found;
    for (const Inbound& inbound : hub.take_inbound()) {
      if (const auto* message = std::get_if<Received>(&inbound)) {
        if (const auto* wanted = std::get_if<T>(&message->message)) found.push_back(*wanted);
      }
      if (const auto* left = std::get_if<PeerLeft>(&inbound)) last_left = left->reason;
      if (const auto* joined = std::get_if<PeerJoined>(&inbound)) joins.push_back(*joined);
    }
    return found;
  }

  std::int64_t now = 1'000 * kMs;
  bool connected = true;
  bool deaf = false;  // bytes are swallowed, the connection seems open
  std::size_t budget = 1U << 20;
  Hub server, client;
  Error last_left;
  std::vector<PeerJoined> joins;

 private:
  struct Wire {
    ConnectionId server = 0, client = 0;
    Bytes down, up;
  };

  static LinkOptions tracker(LinkOptions options) {
    options.role = Role::tracker;
    return options;
  }

  void close_if(bool over, Hub& hub, ConnectionId id) {
    if (over) hub.closed(id, {ErrorCode::closed, "cut"}, now);
  }

  void close(const Wire& wire) {
    server.closed(wire.server, {ErrorCode::closed, "cut"}, now);
    client.closed(wire.client, {ErrorCode::closed, "cut"}, now);
  }

  void move(Hub& from, ConnectionId out, Hub& to, ConnectionId in, Bytes& pending) {
    while (pending.size() < budget) {
      const auto message = from.next_to_write(out, now);
      if (!message) break;
      pending.insert(pending.end(), message->header.begin(), message->header.end());
      pending.insert(pending.end(), message->body->begin(), message->body->end());
    }
    std::size_t left = std::min(pending.size(), budget);
    std::size_t done = 0;
    if (!to.exists(in)) pending.clear();
    while (left > 0 && !pending.empty() && !deaf && to.wants_read(in)) {
      const auto room = to.parser(in).room();
      const std::size_t count = std::min(room.size(), left);
      std::memcpy(room.data(), pending.data() + done, count);
      to.read(in, count, now);
      done += count;
      left -= count;
    }
    pending.erase(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(deaf ? pending.size() : done));
  }

  std::vector<Wire> wires;
};

Command command(std::uint64_t id) {
  Command c;
  c.id = id;
  c.action = Say{"number " + std::to_string(id), "en", ""};
  return c;
}

PoseEstimate pose(FrameId frame) {
  PoseEstimate p;
  p.stamp.frame_id = frame;
  return p;
}

VideoFrame picture(FrameId frame) {
  VideoFrame v;
  v.stamp.frame_id = frame;
  v.width = v.height = 16;
  v.stride = 48;
  v.bytes.assign(48 * 16, 5);
  return v;
}

TEST(Hub, EveryCommandArrivesOnceAndInOrderThroughManyCutLinks) {
  std::mt19937 random(7);
  World world;
  world.budget = 333;  // so that links are cut in the middle of messages
  world.run(5);
  std::vector<std::uint64_t> got, answered;
  std::uint64_t next = 1;
  const auto harvest = [&] {
    for (const Command& c : world.received<Command>(world.client)) {
      got.push_back(c.id);
      Feedback done;
      done.command_id = c.id;
      done.state = FeedbackState::finished;
      world.send(world.client, done);
    }
    for (const Feedback& f : world.received<Feedback>(world.server)) answered.push_back(f.command_id);
  };
  for (int round = 0; round < 200; ++round) {
    for (int i = 0; i < 50; ++i) world.send(world.server, command(next++));
    world.run(1 + static_cast<std::int64_t>(random() % 20));
    harvest();
    world.cut();
    world.run(60);
  }
  for (int i = 0; i < 200 && answered.size() + 1 < next; ++i) {
    world.run(20);
    harvest();
  }
  ASSERT_EQ(got.size(), 10'000U);
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_EQ(got[i], i + 1);
  EXPECT_EQ(answered, got);
}

TEST(Hub, SaysThatTheSameSessionIsBackOrThatItIsAFreshOne) {
  World world;
  world.run(5);
  EXPECT_TRUE(world.received<Command>(world.client).empty());
  ASSERT_EQ(world.joins.size(), 1U);
  const PeerId first = world.joins[0].peer;
  EXPECT_FALSE(world.joins[0].resumed);
  world.cut();
  world.run(80);
  world.received<Command>(world.client);
  ASSERT_EQ(world.joins.size(), 2U);
  EXPECT_TRUE(world.joins[1].resumed);
  EXPECT_EQ(world.joins[1].peer, first);
  world.cut();
  world.server = Hub(Hub::End::server, {}, "");  // killed and started again
  world.run(80);
  world.received<Command>(world.client);
  ASSERT_EQ(world.joins.size(), 3U);
  EXPECT_FALSE(world.joins[2].resumed);
  EXPECT_NE(world.joins[2].peer, first);
}

TEST(Hub, NewestPosesWinAndTheRestIsCounted) {
  World world;
  world.run(5);
  world.budget = 0;  // the link hesitates
  for (FrameId frame = 0; frame < 100; ++frame) world.send(world.server, pose(frame));
  world.budget = 1U << 20;
  world.run(5);
  const auto poses = world.received<PoseEstimate>(world.client);
  ASSERT_EQ(poses.size(), 8U);
  EXPECT_EQ(poses.back().stamp.frame_id, 99U);
  EXPECT_EQ(world.server.stats(world.now)[0].dropped, 92U);
}

TEST(Hub, InLockstepNothingIsDroppedNotEvenByALostLink) {
  LinkOptions lockstep;
  lockstep.lockstep = true;
  World world(lockstep, lockstep);
  world.run(5);
  std::vector<FrameId> poses, pictures;
  const auto harvest = [&] {
    for (const Inbound& inbound : world.client.take_inbound()) {
      const auto* received = std::get_if<Received>(&inbound);
      if (received == nullptr) continue;
      if (const auto* p = std::get_if<PoseEstimate>(&received->message)) poses.push_back(p->stamp.frame_id);
      if (const auto* v = std::get_if<VideoFrame>(&received->message)) pictures.push_back(v->stamp.frame_id);
    }
  };
  world.budget = 3000;
  for (FrameId frame = 0; frame < 100; ++frame) {
    world.send(world.server, pose(frame));
    world.send(world.server, picture(frame));
    if (frame % 10 == 5) world.cut();
    world.run(7);
    harvest();
  }
  world.run(500);
  harvest();
  ASSERT_EQ(poses.size(), 100U);
  ASSERT_EQ(pictures.size(), 100U);
  for (FrameId frame = 0; frame < 100; ++frame) {
    EXPECT_EQ(poses[frame], frame);
    EXPECT_EQ(pictures[frame], frame);
  }
  EXPECT_EQ(world.server.stats(world.now)[0].dropped, 0U);
}

TEST(Hub, LockstepNeedsBothSides) {
  LinkOptions lockstep;
  lockstep.lockstep = true;
  World world(lockstep, {});
  world.run(5);
  world.received<Command>(world.client);
  ASSERT_EQ(world.joins.size(), 1U);
  EXPECT_FALSE(world.joins[0].lockstep);
}

TEST(Hub, NoticesASilentPeerWithinASecondAndAHalf) {
  World world;
  world.run(100);
  world.received<Command>(world.client);
  world.received<Feedback>(world.server);
  world.deaf = true;  // half-open: nothing comes, nothing closes
  world.run(1'350);
  world.received<Command>(world.client);
  EXPECT_EQ(world.last_left.message, "") << "two heartbeats may be lost or late";
  world.run(100);
  world.received<Command>(world.client);
  EXPECT_EQ(world.last_left.code, ErrorCode::timeout);
  world.deaf = false;
  world.run(3'000);
  EXPECT_TRUE(world.received<Command>(world.client).empty());
  EXPECT_TRUE(world.joins.back().resumed);
}

TEST(Hub, HeartbeatsKeepAnIdleLinkAlive) {
  World world;
  world.run(10'000);
  world.received<Command>(world.client);
  EXPECT_EQ(world.joins.size(), 1U);
  EXPECT_EQ(world.last_left.message, "");
}

// More than 10,000 at once: 5,000 a second are read, nothing is lost, and nobody is taken for dead meanwhile.
TEST(Hub, WhatComesTooFastWaitsInTheSocket) {
  World world;
  world.run(300);
  ASSERT_EQ(world.received<Command>(world.server).size(), 0U);
  constexpr std::size_t kAll = 25'000;
  for (std::uint64_t id = 1; id <= kAll; ++id) world.send(world.client, command(id));
  std::size_t got = 0;
  const auto run_for = [&](std::int64_t ms) {
    for (std::int64_t i = 0; i < ms; i += 100) {
      world.run(100);
      got += world.received<Command>(world.server).size();
    }
  };
  run_for(500);
  EXPECT_GE(got, 10'000U);
  EXPECT_LE(got, 10'000U + 2'500 + 1'500) << "what the reading buffer held when the reserve was used up comes along";
  run_for(1'500);
  EXPECT_LE(got, 10'000U + 10'000 + 1'500);
  run_for(3'000);
  EXPECT_EQ(got, kAll);
  EXPECT_EQ(world.joins.size(), 1U) << "the link was lost meanwhile";
}

TEST(Hub, ProvesTheTokenBothWays) {
  const std::string token = "a token of some length", other = "another token of length";
  World good({}, {}, token, token);
  good.run(20);
  good.received<Command>(good.client);
  EXPECT_EQ(good.joins.size(), 1U);

  const std::vector<std::pair<std::string, std::string>> bad{{token, other}, {token, ""}, {"", token}};
  for (const auto& [server_token, client_token] : bad) {
    World world({}, {}, server_token, client_token);
    world.run(20);
    world.received<Command>(world.client);
    EXPECT_TRUE(world.joins.empty());
    EXPECT_EQ(world.last_left.code, ErrorCode::refused);
    EXPECT_NE(world.last_left.message.find("token"), std::string::npos);
    EXPECT_TRUE(world.server.stats(world.now).empty() || client_token == token);
  }
}

TEST(Hub, KnowsTheOffsetOfTheOtherClock) {
  World world;
  world.run(300);
  const auto stats = world.client.stats(world.now);
  ASSERT_EQ(stats.size(), 1U);
  EXPECT_LE(std::abs(stats[0].clock_offset_ns), stats[0].clock_bound_ns);
  EXPECT_LE(stats[0].clock_bound_ns, 3 * kMs);  // the test's wire takes up to a millisecond each way
}

// An attempt that began while the link was silent is lost, whenever that was; the next one must not wait long.
TEST(Hub, TheSessionIsResumedWithinASecondAfterTheLinkIsBack) {
  for (std::int64_t gap_ms = 3'000; gap_ms < 4'500; gap_ms += 97) {
    World world;
    world.run(200);
    world.received<Feedback>(world.client);
    world.joins.clear();
    world.deaf = true;
    world.run(gap_ms);
    world.deaf = false;
    world.run(1'000);
    world.received<Feedback>(world.client);
    ASSERT_EQ(world.joins.size(), 1U) << gap_ms;
    EXPECT_TRUE(world.joins[0].resumed) << gap_ms;
  }
}

TEST(Hub, ASessionEndsWhenTooMuchWaitsForAPeerThatIsAway) {
  World world;
  world.run(5);
  world.connected = false;
  world.cut();
  const auto outgoing = *make_outgoing(command(1), {});
  for (int i = 0; i < 70'000; ++i) world.server.broadcast(outgoing, world.now);
  world.received<Feedback>(world.server);
  EXPECT_EQ(world.last_left.code, ErrorCode::limit_exceeded);
  EXPECT_TRUE(world.server.stats(world.now).empty());
}

// A connection that the test speaks for itself.
class Stranger {
 public:
  explicit Stranger(Hub& hub) : hub_(hub), id_(*hub.accepted(1)) {}

  void say(std::uint16_t type, ByteView body, std::uint64_t seq = 0) {
    Header header;
    header.type = type;
    header.seq = seq;
    header.flags = seq != 0 ? kFlagKept : 0;
    raw(seal(header, body));
    raw(body);
  }

  void say(const Message& message, std::uint64_t seq = 0) {
    say(static_cast<std::uint16_t>(type_of(message)), *encode(message), seq);
  }

  void raw(ByteView bytes) {
    while (!bytes.empty() && hub_.wants_read(id_)) {
      const auto room = hub_.parser(id_).room();
      const std::size_t count = std::min(room.size(), bytes.size());
      std::memcpy(room.data(), bytes.data(), count);
      hub_.read(id_, count, 1);
      bytes = bytes.subspan(count);
    }
  }

  // The next message that the hub says to it, of any type.
  std::optional<Message> hears() {
    const auto wire = hub_.next_to_write(id_, 1);
    if (!wire) return std::nullopt;
    const auto header = read_header(wire->header);
    return *decode(static_cast<MessageType>(header->type), *wire->body);
  }

  bool dismissed() const { return hub_.finished(id_); }

 private:
  Hub& hub_;
  ConnectionId id_;
};

Hub a_server() {
  LinkOptions options;
  options.role = Role::tracker;
  return Hub(Hub::End::server, options, "");
}

TEST(Hub, NamesBothRangesWhenNoVersionIsCommon) {
  Hub hub = a_server();
  Stranger stranger(hub);
  Hello hello;
  hello.version_min = 2;
  hello.version_max = 3;
  stranger.say(hello);
  const auto answer = stranger.hears();
  ASSERT_TRUE(answer && std::holds_alternative<ErrorReport>(*answer));
  EXPECT_EQ(std::get<ErrorReport>(*answer).code, 6);
  EXPECT_NE(std::get<ErrorReport>(*answer).message.find("peer speaks versions 2-3, this program speaks version 1"),
            std::string::npos);
  EXPECT_TRUE(stranger.dismissed());
}

TEST(Hub, AgreesWithAPeerThatSpeaksMoreVersions) {
  Hub hub = a_server();
  Stranger stranger(hub);
  Hello hello;
  hello.version_max = 9;
  stranger.say(hello);
  const auto answer = stranger.hears();
  ASSERT_TRUE(answer && std::holds_alternative<Welcome>(*answer));
  EXPECT_EQ(std::get<Welcome>(*answer).version, 1);
}

TEST(Hub, PassesOverUnknownTypesAndCountsThem) {
  Hub hub = a_server();
  Stranger stranger(hub);
  stranger.say(Hello{});
  stranger.say(1000, Bytes{1, 2, 3});
  stranger.say(1000, Bytes{1, 2, 3}, 1);  // kept: its number counts
  stranger.say(command(5), 2);
  EXPECT_EQ(hub.stats(1)[0].skipped, 2U);
  const auto inbound = hub.take_inbound();
  ASSERT_EQ(inbound.size(), 2U);
  EXPECT_EQ(std::get<Command>(std::get<Received>(inbound[1]).message).id, 5U);
}

TEST(Hub, DismissesWhoBreaksTheRules) {
  const Bytes rubbish(100, 'x');
  const std::vector<std::function<void(Stranger&)>> sins{
      [&](Stranger& s) { s.raw(rubbish); },
      [](Stranger& s) { s.say(command(1), 1); },                        // before HELLO
      [](Stranger& s) { s.say(Hello{}), s.say(command(1), 2); },        // a gap
      [](Stranger& s) { s.say(Hello{}), s.say(Hello{}); },              // twice
      [](Stranger& s) { s.say(Hello{}), s.say(Acknowledge{7}); },       // of what was never sent
      [](Stranger& s) { s.say(Hello{}), s.say(17, Bytes(180, 255)); },  // a pose of NaN
      [](Stranger& s) {
        s.say(Hello{}), s.say(48, Bytes{'{', '}'}, 1);
      },
  };
  for (std::size_t i = 0; i < sins.size(); ++i) {
    Hub hub = a_server();
    Stranger stranger(hub);
    sins[i](stranger);
    std::optional<Message> last;
    while (auto heard = stranger.hears()) last = heard;
    ASSERT_TRUE(last) << i;
    EXPECT_TRUE(std::holds_alternative<ErrorReport>(*last)) << i;
    EXPECT_TRUE(stranger.dismissed()) << i;
  }
}

TEST(Hub, DismissesWhoSendsHalfAMessageAndWhoSaysNothing) {
  Hub hub = a_server();
  Stranger silent(hub);
  hub.tick(2'999 * kMs);
  EXPECT_FALSE(silent.dismissed());
  hub.tick(3'001 * kMs);
  ASSERT_TRUE(silent.hears());
  EXPECT_TRUE(silent.dismissed());
}

TEST(Hub, APeerThatAsksAndNeverReadsCostsLittle) {
  Hub hub = a_server();
  Stranger stranger(hub);
  stranger.say(Hello{});
  for (int i = 0; i < 100'000; ++i) stranger.say(ClockRequest{i});
  int answers = 0;
  while (stranger.hears()) ++answers;
  EXPECT_LE(answers, 300);
}

}  // namespace
}  // namespace counterpart
