// Connections that do not behave: the link that does must not feel them, and nothing may be left behind.
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "protocol/transport/endpoint.hpp"
#include "protocol/vocabulary/result.hpp"
#include "tests/protocol/robustness/footprint.hpp"
#include "tests/protocol/robustness/scale.hpp"
#include "tests/protocol/robustness/stranger.hpp"

namespace counterpart {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::size_t kMiB = 1024;  // in KiB

LinkOptions link_options(Role role) {
  LinkOptions options;
  options.role = role;
  options.software = "test";
  return options;
}

// A game between a tracker and a renderer that behave.
struct Game {
  Game() : tracker(*listen_tcp("127.0.0.1:0", link_options(Role::tracker))) {
    renderer = *connect_tcp(tracker->address(), link_options(Role::renderer), 5 * kSecond);
  }

  // Commands for everybody who listens; the renderer has to get all of them.
  void play(int commands) {
    for (int i = 0; i < commands; ++i) {
      Command command;
      command.id = ++sent;
      command.action = Say{"hello", "en", ""};
      tracker->broadcast(command);
      if (i % 100 == 0) listen(0);
    }
  }

  void listen(std::int64_t wait_ns) {
    static_cast<void>(tracker->receive(0));
    for (const Inbound& inbound : renderer->receive(wait_ns)) {
      // A machine that is busy with other things may stop these threads for longer than a peer may be silent.
      const auto* lost = std::get_if<PeerLeft>(&inbound);
      EXPECT_TRUE(lost == nullptr || lost->reason.code == ErrorCode::timeout) << lost->reason.message;
      const auto* received = std::get_if<Received>(&inbound);
      const auto* command = received == nullptr ? nullptr : std::get_if<Command>(&received->message);
      if (command == nullptr) continue;
      EXPECT_EQ(command->id, ++heard);
    }
  }

  void listen_until_all_came() {
    for (int i = 0; i < 300 && heard < sent; ++i) listen(kSecond / 10);
    EXPECT_EQ(heard, sent);
  }

  std::unique_ptr<Endpoint> tracker, renderer;
  std::uint64_t sent = 0, heard = 0;
};

VideoFrame a_picture() {
  VideoFrame picture;
  picture.width = 720;
  picture.height = 576;
  picture.stride = 2160;
  picture.bytes.assign(std::size_t{2160} * 576, 9);
  return picture;
}

TEST(Strangers, WhoNeverReadsCostsBoundedMemoryAndIsLetGo) {
  Game game;
  Stranger deaf(game.tracker->address());
  Hello hello;
  hello.role = Role::observer;
  ASSERT_TRUE(deaf.say(hello));
  ASSERT_TRUE(deaf.hear(MessageType::welcome));
  const Footprint before = footprint();
  const VideoFrame picture = a_picture();
  bool talking = true;
  const int rounds = scaled(80, 800);
  for (int round = 0; round < rounds; ++round) {
    talking = talking && deaf.say(Heartbeat{});  // alive, only not listening
    game.play(1'000);
    game.tracker->broadcast(picture);
    game.listen_until_all_came();
  }
  // Its connection has a second for last words that it does not read either.
  for (int i = 0; i < 100 && talking; ++i) {
    talking = deaf.say(Heartbeat{});
    game.listen(kSecond / 10);
  }
  EXPECT_FALSE(talking) << "it was never let go";
  if (!memory_can_be_measured()) return;
  // At most 64 MiB wait for a peer, and as much again is overhead of small messages.
  EXPECT_LE(footprint().resident_kib, before.resident_kib + 128 * kMiB);
}

TEST(Strangers, WhoSendsAByteASecondIsLetGoAndNotFelt) {
  Game game;
  Stranger slow(game.tracker->address());
  const Bytes hello = on_the_wire(Hello{});
  std::size_t taken = 0;
  while (taken < hello.size() && slow.raw(ByteView(hello).subspan(taken, 1))) {
    ++taken;
    game.play(100);
    for (int i = 0; i < 10; ++i) {
      game.listen(0);
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  EXPECT_LT(taken, hello.size()) << "a whole HELLO went through at one byte a second";
  game.listen_until_all_came();
}

TEST(Strangers, FiveHundredAtOnceLeaveNothingBehind) {
  Game game;
  game.play(100);
  game.listen_until_all_came();
  Footprint before;
  const int rounds = scaled(2, 10);
  for (int round = 0; round < rounds; ++round) {
    {
      std::vector<std::unique_ptr<Stranger>> crowd;
      for (int i = 0; i < 500; ++i) crowd.push_back(std::make_unique<Stranger>(game.tracker->address()));
      game.play(1'000);
      game.listen_until_all_came();
      int refused = 0;
      // Those that were let in say nothing, and are sent away for that.
      for (const auto& stranger : crowd) {
        const auto last = stranger->hear();
        const auto* report = last ? std::get_if<ErrorReport>(&*last) : nullptr;
        refused += report != nullptr && report->code == static_cast<std::uint16_t>(ErrorCode::unavailable) ? 1 : 0;
      }
      EXPECT_GE(refused, 400) << "at most 64 connections are served";
    }
    game.play(100);
    game.listen_until_all_came();
    if (round == 0) before = footprint();  // what the first round leaves is not a leak
  }
  auto late = connect_tcp(game.tracker->address(), link_options(Role::observer), 5 * kSecond);
  EXPECT_TRUE(late) << late.error().message;
  late->reset();
  const Footprint after = footprint();
  EXPECT_EQ(after.descriptors, before.descriptors);
  if (!memory_can_be_measured()) return;
  EXPECT_LE(after.resident_kib, before.resident_kib + 4 * kMiB);
}

}  // namespace
}  // namespace counterpart
