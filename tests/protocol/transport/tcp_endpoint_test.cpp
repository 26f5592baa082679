#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "protocol/capture/session_reader.hpp"
#include "protocol/h264/h264.hpp"
#include "protocol/transport/address.hpp"
#include "protocol/transport/endpoint.hpp"
#include "protocol/transport/jpeg.hpp"
#include "tests/support/inbound.hpp"
#include "tests/support/link_options.hpp"
#include "tests/support/relay.hpp"

namespace counterpart {
namespace {

using testing_support::collect;
using testing_support::first;
using testing_support::joined;
using testing_support::messages;
using testing_support::options_of;

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(TcpEndpoint, CarriesCommandsOneWayFeedbackTheOtherAndPicturesBeside) {
  auto tracker = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
  ASSERT_TRUE(tracker) << tracker.error().message;
  auto renderer = connect_tcp((*tracker)->address(), options_of(Role::renderer), kSecond);
  ASSERT_TRUE(renderer) << renderer.error().message;
  const PeerId peer = joined(**tracker);
  ASSERT_NE(peer, 0U);
  const PeerId back = joined(**renderer);

  Command command;
  command.id = 7;
  command.action = Say{"Good evening", "en", ""};
  (*tracker)->send(peer, command);
  VideoFrame picture;
  picture.stamp = {3, 99};
  picture.width = 720;
  picture.height = 576;
  picture.stride = 2160;
  picture.bytes.assign(2160 * 576, 17);
  (*tracker)->broadcast(picture);
  const auto got = collect(
      **renderer, [](const auto& a) { return !messages<Command>(a).empty() && !messages<VideoFrame>(a).empty(); });
  ASSERT_EQ(messages<Command>(got).size(), 1U);
  EXPECT_EQ(messages<Command>(got)[0], command);
  ASSERT_EQ(messages<VideoFrame>(got).size(), 1U);
  EXPECT_EQ(messages<VideoFrame>(got)[0], picture);

  Feedback feedback;
  feedback.command_id = 7;
  feedback.state = FeedbackState::finished;
  (*renderer)->send(back, feedback);
  const auto answer = collect(**tracker, [](const auto& a) { return !messages<Feedback>(a).empty(); });
  EXPECT_EQ(messages<Feedback>(answer), std::vector<Feedback>{feedback});
}

TEST(TcpEndpoint, SaysThatAPortIsInUse) {
  auto first_one = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
  ASSERT_TRUE(first_one);
  auto second = listen_tcp((*first_one)->address(), options_of(Role::tracker));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::unavailable);
  EXPECT_NE(second.error().message.find("in use"), std::string::npos);
}

std::uint16_t port_of(const Endpoint& endpoint) {
  return parse_address(endpoint.address())->port;
}

Command say(std::uint64_t id) {
  Command command;
  command.id = id;
  command.action = Say{"hello", "en", ""};
  return command;
}

TEST(TcpEndpoint, NoCommandIsLostOrDoubledWhenTheLinkIsCutAgainAndAgain) {
  auto tracker = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
  ASSERT_TRUE(tracker);
  Relay relay(port_of(**tracker));
  auto renderer = connect_tcp(relay.address(), options_of(Role::renderer), 2 * kSecond);
  ASSERT_TRUE(renderer) << renderer.error().message;
  const PeerId peer = joined(**tracker);
  std::vector<std::uint64_t> got;
  const auto harvest = [&](std::int64_t wait_ns) {
    for (const Command& command : messages<Command>((*renderer)->receive(wait_ns))) got.push_back(command.id);
  };
  std::uint64_t next = 1;
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 100; ++i) (*tracker)->send(peer, say(next++));
    harvest(2'000'000);
    relay.cut();
    harvest(10'000'000);
  }
  for (int i = 0; i < 100 && got.size() + 1 < next; ++i) harvest(kSecond / 10);
  ASSERT_EQ(got.size(), 2000U);
  for (std::size_t i = 0; i < got.size(); ++i) ASSERT_EQ(got[i], i + 1);
}

TEST(TcpEndpoint, AFreshServerIsFoundAgainAndIsNotTakenForTheOldOne) {
  auto tracker = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
  const std::string address = (*tracker)->address();
  auto renderer = connect_tcp(address, options_of(Role::renderer), 2 * kSecond);
  ASSERT_TRUE(renderer);
  const PeerId before = joined(**renderer);
  tracker->reset();
  tracker = listen_tcp(address, options_of(Role::tracker));
  ASSERT_TRUE(tracker) << tracker.error().message;
  const auto all = collect(**renderer, [](const auto& a) { return first<PeerJoined>(a) != nullptr; });
  ASSERT_NE(first<PeerLeft>(all), nullptr);
  ASSERT_NE(first<PeerJoined>(all), nullptr);
  EXPECT_FALSE(first<PeerJoined>(all)->resumed);
  EXPECT_NE(first<PeerJoined>(all)->peer, before);
}

TEST(TcpEndpoint, AHalfOpenLinkIsNoticedAndComesBack) {
  LinkOptions quick = options_of(Role::tracker);
  quick.heartbeat_ns = kSecond / 10;
  quick.dead_after_ns = 20 * kSecond;  // the tracker is patient, so that it is the renderer who notices
  auto tracker = listen_tcp("127.0.0.1:0", quick);
  Relay relay(port_of(**tracker));
  quick.role = Role::renderer;
  quick.dead_after_ns = kSecond;  // long enough for a machine that is busy with other things
  auto renderer = connect_tcp(relay.address(), quick, 2 * kSecond);
  ASSERT_TRUE(renderer);
  joined(**renderer);
  relay.silence(true);
  const auto gone = collect(**renderer, [](const auto& a) { return first<PeerLeft>(a) != nullptr; });
  ASSERT_NE(first<PeerLeft>(gone), nullptr);
  EXPECT_EQ(first<PeerLeft>(gone)->reason.code, ErrorCode::timeout);
  relay.silence(false);
  const auto back = collect(**renderer, [](const auto& a) { return first<PeerJoined>(a) != nullptr; });
  ASSERT_NE(first<PeerJoined>(back), nullptr);
  EXPECT_TRUE(first<PeerJoined>(back)->resumed);
}

// BYE goes out on both lanes, and either may arrive first.
TEST(TcpEndpoint, AGoodbyeIsToldApartFromALostLink) {
  for (int round = 0; round < 20; ++round) {
    auto tracker = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
    auto renderer = connect_tcp((*tracker)->address(), options_of(Role::renderer), 2 * kSecond);
    ASSERT_TRUE(renderer);
    const PeerId peer = joined(**tracker);
    VideoFrame picture;
    picture.width = picture.height = 8;
    picture.stride = 24;
    picture.bytes.resize(192);
    (*tracker)->send(peer, picture);
    collect(**renderer, [](const auto& a) { return !messages<VideoFrame>(a).empty(); });  // both lanes are open
    tracker->reset();
    const auto all = collect(**renderer, [](const auto& a) { return first<PeerLeft>(a) != nullptr; });
    ASSERT_NE(first<PeerLeft>(all), nullptr);
    EXPECT_TRUE(first<PeerLeft>(all)->said_goodbye) << first<PeerLeft>(all)->reason.message;
  }
}

TEST(TcpEndpoint, SaysThatNobodyListens) {
  std::string address;
  {
    auto gone = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
    address = (*gone)->address();
  }
  auto link = connect_tcp(address, options_of(Role::renderer), kSecond / 5);
  ASSERT_FALSE(link);
  EXPECT_EQ(link.error().code, ErrorCode::unavailable);
  EXPECT_NE(link.error().message.find("refused"), std::string::npos);
  EXPECT_NE(link.error().message.find(address), std::string::npos);
}

TEST(TcpEndpoint, OtherHostsNeedATokenAndBothSidesTheSame) {
  auto open = listen_tcp("0.0.0.0:0", options_of(Role::tracker));
  ASSERT_FALSE(open);
  EXPECT_EQ(open.error().code, ErrorCode::refused);

  const std::string file = testing::TempDir() + "counterpart_token";
  const auto write = [&](const std::string& name, const std::string& token) {
    std::ofstream(name) << token << '\n';
    std::filesystem::permissions(name, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  };
  write(file, "0123456789abcdef0123456789abcdef");
  write(file + "2", "another token that is long enough");
  LinkOptions server = options_of(Role::tracker);
  server.token_file = file;
  auto tracker = listen_tcp("0.0.0.0:0", server);
  ASSERT_TRUE(tracker) << tracker.error().message;
  const std::string address = "127.0.0.1:" + std::to_string(port_of(**tracker));

  LinkOptions client = options_of(Role::renderer);
  auto without = connect_tcp(address, client, kSecond);
  ASSERT_FALSE(without);
  EXPECT_EQ(without.error().code, ErrorCode::refused);
  client.token_file = file + "2";
  auto wrong = connect_tcp(address, client, kSecond);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, ErrorCode::refused);
  client.token_file = file;
  auto good = connect_tcp(address, client, 2 * kSecond);
  EXPECT_TRUE(good) << good.error().message;
  std::filesystem::permissions(file, std::filesystem::perms::all);
  EXPECT_EQ(connect_tcp(address, client, kSecond).error().code, ErrorCode::refused) << "readable by others";
}

TEST(TcpEndpoint, TurnsPicturesIntoJpegWhenAsked) {
  LinkOptions server = options_of(Role::tracker);
  server.video_codec = PixelCodec::jpeg;
  auto tracker = listen_tcp("127.0.0.1:0", server);
  auto renderer = connect_tcp((*tracker)->address(), options_of(Role::renderer), 2 * kSecond);
  joined(**tracker);
  VideoFrame picture;
  picture.width = picture.height = 64;
  picture.stride = 192;
  picture.bytes.assign(192 * 64, 200);
  (*tracker)->broadcast(picture);
  const auto got = collect(**renderer, [](const auto& a) { return !messages<VideoFrame>(a).empty(); });
  ASSERT_EQ(messages<VideoFrame>(got).size(), 1U);
  const VideoFrame jpeg = messages<VideoFrame>(got)[0];
  EXPECT_EQ(jpeg.codec, PixelCodec::jpeg);
  const auto raw = convert(jpeg, PixelCodec::raw_bgr8);
  ASSERT_TRUE(raw) << raw.error().message;
  for (const std::uint8_t value : raw->bytes) ASSERT_NEAR(value, 200, 3);
}

// A line that is slow enough would have no room for poses beside it.
TEST(TcpEndpoint, DebugViewsGoToWhoAskedForThem) {
  auto tracker = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
  LinkOptions asking = options_of(Role::observer);
  asking.want_debug = true;
  auto curious = connect_tcp((*tracker)->address(), asking, 2 * kSecond);
  joined(**tracker);
  auto other = connect_tcp((*tracker)->address(), options_of(Role::observer), 2 * kSecond);
  joined(**tracker);
  DebugView view;
  view.stamp = {7, 7};
  (*tracker)->broadcast(view);
  (*tracker)->broadcast(FrameDone{{7, 7}});  // comes after it
  const auto is_over = [](const auto& all) { return !messages<FrameDone>(all).empty(); };
  EXPECT_EQ(messages<DebugView>(collect(**curious, is_over)), std::vector<DebugView>{view});
  EXPECT_TRUE(messages<DebugView>(collect(**other, is_over)).empty());
}

// Of one shade, which tells which one it is.
VideoFrame shade(FrameId frame) {
  VideoFrame picture;
  picture.stamp = {frame, static_cast<std::int64_t>(frame) * 40'000'000};
  picture.width = picture.height = 64;
  picture.stride = 192;
  picture.bytes.assign(192 * 64, static_cast<std::uint8_t>(20 * (frame % 12)));
  return picture;
}

bool is_shown(const VideoFrame& picture, FrameId frame) {
  const int wanted = shade(frame).bytes[0];
  return picture.stamp.frame_id == frame && picture.codec == PixelCodec::raw_bgr8 &&
         std::all_of(picture.bytes.begin(), picture.bytes.end(),
                     [&](std::uint8_t value) { return std::abs(value - wanted) <= 8; });
}

LinkOptions with_h264(Role role) {
  LinkOptions options = options_of(role);
  use_h264(options);
  if (role == Role::tracker) options.video_codec = PixelCodec::h264;
  return options;
}

// What each viewer gets of the next picture; for a while, since video's own connection comes a little later.
std::vector<VideoFrame> seen_of_next(FrameId& frame, Endpoint& tracker, const std::vector<Endpoint*>& viewers) {
  std::vector<VideoFrame> seen;
  for (int i = 0; i < 100 && seen.size() < viewers.size(); ++i) {
    seen.clear();
    tracker.broadcast(shade(++frame));
    for (Endpoint* viewer : viewers) {
      for (const VideoFrame& picture : messages<VideoFrame>(viewer->receive(kSecond / 10))) {
        if (picture.stamp.frame_id == frame) seen.push_back(picture);
      }
    }
  }
  return seen;
}

class TcpEndpointH264 : public testing::Test {
 protected:
  void SetUp() override {
    if (make_h264_encoder() == nullptr) GTEST_SKIP() << "this FFmpeg has no libx264";
  }

  std::unique_ptr<Endpoint> join(const LinkOptions& options) {
    auto viewer = connect_tcp(tracker_->address(), options, 2 * kSecond);
    EXPECT_NE(joined(*tracker_), 0U);
    return std::move(*viewer);
  }

  const std::unique_ptr<Endpoint> tracker_ = std::move(*listen_tcp("127.0.0.1:0", with_h264(Role::tracker)));
  FrameId frame_ = 0;
};

TEST_F(TcpEndpointH264, PicturesArriveRawAndALateViewerSeesTheNextOnes) {
  const auto viewer = join(with_h264(Role::renderer));
  for (int i = 0; i < 15; ++i) {
    const auto seen = seen_of_next(frame_, *tracker_, {viewer.get()});
    ASSERT_EQ(seen.size(), 1U);
    EXPECT_TRUE(is_shown(seen[0], frame_));
  }
  EXPECT_LE(frame_, 30U);
  const auto late = join(with_h264(Role::observer));
  for (int i = 0; i < 15; ++i) {
    const auto seen = seen_of_next(frame_, *tracker_, {viewer.get(), late.get()});
    ASSERT_EQ(seen.size(), 2U);
    EXPECT_TRUE(is_shown(seen[0], frame_));
    EXPECT_TRUE(is_shown(seen[1], frame_));
  }
  EXPECT_LE(frame_, 60U) << "it does not wait for the fiftieth picture";
}

TEST_F(TcpEndpointH264, WhileAViewerTakesNoneAllGetJpeg) {
  LinkOptions recorder = options_of(Role::observer);
  recorder.takes_h264 = true;  // and does not look at it
  const auto viewer = join(recorder);
  ASSERT_EQ(seen_of_next(frame_, *tracker_, {viewer.get()}).at(0).codec, PixelCodec::h264);
  auto old = join(options_of(Role::observer));
  for (const VideoFrame& picture : seen_of_next(frame_, *tracker_, {viewer.get(), old.get()})) {
    EXPECT_EQ(picture.codec, PixelCodec::jpeg);
  }
  old.reset();
  collect(*tracker_, [](const auto& all) { return first<PeerLeft>(all) != nullptr; });
  EXPECT_EQ(seen_of_next(frame_, *tracker_, {viewer.get()}).at(0).codec, PixelCodec::h264);
}

// The end of a flood must come although the sender does nothing more.
TEST(TcpEndpoint, AFloodArrivesWholeAndInOrder) {
  auto camera = listen_tcp("127.0.0.1:0", options_of(Role::camera));
  auto tracker = connect_tcp((*camera)->address(), options_of(Role::tracker), 2 * kSecond);
  ASSERT_TRUE(tracker) << tracker.error().message;
  const PeerId peer = joined(**tracker);
  constexpr std::size_t kCount = 5'003;
  for (FrameId frame = 1; frame <= kCount; ++frame) (*tracker)->send(peer, FrameDone{{frame, 0}});
  const auto got =
      messages<FrameDone>(collect(**camera, [](const auto& all) { return messages<FrameDone>(all).size() >= kCount; }));
  ASSERT_EQ(got.size(), kCount);
  for (std::size_t i = 0; i < kCount; ++i) ASSERT_EQ(got[i].stamp.frame_id, i + 1);
}

TEST(TcpEndpoint, WhatCannotBeSentComesBackAsAReport) {
  auto tracker = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
  PoseEstimate pose;
  pose.rms_px = -1;
  (*tracker)->broadcast(pose);
  const auto reports = messages<ErrorReport>((*tracker)->receive(kSecond));
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_NE(reports[0].message.find("pose"), std::string::npos);
}

TEST(TcpEndpoint, ACaptureHoldsWhatWentBothWays) {
  const std::string path = testing::TempDir() + "counterpart_link.mcap";
  {
    LinkOptions server = options_of(Role::tracker);
    server.record_file = path;
    auto tracker = listen_tcp("127.0.0.1:0", server);
    ASSERT_TRUE(tracker) << tracker.error().message;
    auto renderer = connect_tcp((*tracker)->address(), options_of(Role::renderer), 2 * kSecond);
    (*tracker)->send(joined(**tracker), say(3));
    collect(**renderer, [](const auto& a) { return !messages<Command>(a).empty(); });
    Feedback done;
    done.command_id = 3;
    (*renderer)->broadcast(done);
    collect(**tracker, [](const auto& a) { return !messages<Feedback>(a).empty(); });
  }
  auto reader = SessionReader::open(path);
  ASSERT_TRUE(reader);
  int commands_out = 0, feedback_in = 0;
  while (const auto recorded = (*reader)->next()) {
    commands_out += !recorded->incoming && std::holds_alternative<Command>(recorded->message);
    feedback_in += recorded->incoming && std::holds_alternative<Feedback>(recorded->message);
  }
  EXPECT_EQ(commands_out, 1);
  EXPECT_EQ(feedback_in, 1);
  EXPECT_TRUE((*reader)->file().complete());
}

TEST(MemoryLink, IsTheSameWithoutSockets) {
  auto [tracker, renderer] = memory_link(options_of(Role::tracker), options_of(Role::renderer));
  const PeerId peer = joined(*tracker);
  ASSERT_NE(peer, 0U);
  for (std::uint64_t id = 1; id <= 500; ++id) tracker->send(peer, say(id));
  const auto got = collect(*renderer, [](const auto& a) { return messages<Command>(a).size() >= 500; });
  ASSERT_EQ(messages<Command>(got).size(), 500U);
  EXPECT_EQ(messages<Command>(got)[499].id, 500U);
  tracker.reset();
  const auto end = collect(*renderer, [](const auto& a) { return first<PeerLeft>(a) != nullptr; });
  ASSERT_NE(first<PeerLeft>(end), nullptr);
}

}  // namespace
}  // namespace counterpart
