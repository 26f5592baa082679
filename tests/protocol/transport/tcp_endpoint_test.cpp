#include <chrono>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "protocol/transport/endpoint.hpp"

namespace counterpart {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

LinkOptions options_of(Role role) {
  LinkOptions options;
  options.role = role;
  options.software = "test";
  return options;
}

// Collects what comes until the condition holds or ten seconds have passed.
std::vector<Inbound> collect(Endpoint& endpoint, const std::function<bool(const std::vector<Inbound>&)>& enough) {
  std::vector<Inbound> all;
  for (int i = 0; i < 100 && !enough(all); ++i) {
    for (Inbound& inbound : endpoint.receive(kSecond / 10)) all.push_back(std::move(inbound));
  }
  return all;
}

template <class T>
std::vector<T> messages(const std::vector<Inbound>& all) {
  std::vector<T> found;
  for (const Inbound& inbound : all) {
    const auto* received = std::get_if<Received>(&inbound);
    if (received == nullptr) continue;
    if (const auto* message = std::get_if<T>(&received->message)) found.push_back(*message);
  }
  return found;
}

template <class T>
const T* first(const std::vector<Inbound>& all) {
  for (const Inbound& inbound : all) {
    if (const auto* found = std::get_if<T>(&inbound)) return found;
  }
  return nullptr;
}

PeerId joined(Endpoint& endpoint) {
  const auto all = collect(endpoint, [](const auto& a) { return first<PeerJoined>(a) != nullptr; });
  const auto* peer = first<PeerJoined>(all);
  return peer == nullptr ? 0 : peer->peer;
}

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

}  // namespace
}  // namespace counterpart
