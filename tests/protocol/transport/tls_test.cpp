#include "protocol/transport/tls.hpp"

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <boost/asio.hpp>
#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include "protocol/transport/address.hpp"
#include "protocol/transport/certificates.hpp"
#include "protocol/transport/endpoint.hpp"
#include "tests/support/inbound.hpp"
#include "tests/support/link_options.hpp"
#include "tests/support/program.hpp"
#include "tests/support/relay.hpp"

namespace counterpart {
namespace {

using std::chrono::days;
using testing_support::collect;
using testing_support::joined;
using testing_support::messages;
using testing_support::options_of;
using testing_support::TemporaryFolder;

constexpr std::int64_t kSecond = 1'000'000'000;

class Tls : public testing::Test {
 protected:
  // The folder of an installation with a file for a tracker and one for a renderer.
  std::string installation(const std::string& name, days valid = days(10)) {
    const auto files = make_certificates(folder_.path(name), {"tracker", "renderer"}, valid);
    EXPECT_TRUE(files) << files.error().message;
    return folder_.path(name);
  }

  static LinkOptions with(Role role, const std::string& tls_file) {
    LinkOptions options = options_of(role);
    options.tls_file = tls_file;
    return options;
  }

  static std::unique_ptr<Endpoint> listen(const std::string& tls_file) {
    auto tracker = listen_tcp("127.0.0.1:0", with(Role::tracker, tls_file));
    EXPECT_TRUE(tracker) << tracker.error().message;
    return tracker ? std::move(*tracker) : nullptr;
  }

  // The sentence with which a renderer is turned away; empty: it was let in.
  static std::string refusal(const Endpoint& tracker, const std::string& tls_file) {
    auto renderer = connect_tcp(tracker.address(), with(Role::renderer, tls_file), 2 * kSecond);
    return renderer ? "" : renderer.error().message;
  }

  static bool mentions(const std::string& sentence, const std::string& word) {
    return sentence.find(word) != std::string::npos;
  }

  TemporaryFolder folder_;
};

Command say(std::uint64_t id, const std::string& text) {
  Command command;
  command.id = id;
  command.action = Say{text, "en", ""};
  return command;
}

TEST_F(Tls, CarriesCommandsAndPicturesBothWays) {
  const std::string home = installation("home");
  const auto tracker = listen(home + "/tracker.pem");
  auto renderer = connect_tcp(tracker->address(), with(Role::renderer, home + "/renderer.pem"), 2 * kSecond);
  ASSERT_TRUE(renderer) << renderer.error().message;
  ASSERT_NE(joined(*tracker), 0U);
  VideoFrame picture;
  picture.width = 720;
  picture.height = 576;
  picture.stride = 2160;
  picture.bytes.resize(2160 * 576);
  for (std::size_t i = 0; i < picture.bytes.size(); ++i) picture.bytes[i] = static_cast<std::uint8_t>(i * 7 / 5);
  tracker->broadcast(picture);
  tracker->broadcast(say(7, "Good evening"));
  const auto got = collect(**renderer, [](const auto& all) {
    return !messages<VideoFrame>(all).empty() && !messages<Command>(all).empty();
  });
  ASSERT_EQ(messages<Command>(got).size(), 1U);
  ASSERT_EQ(messages<VideoFrame>(got).size(), 1U);
  EXPECT_EQ(messages<VideoFrame>(got)[0].bytes, picture.bytes);
  (*renderer)->broadcast(Feedback{.command_id = 7, .state = FeedbackState::finished});
  const auto back = collect(*tracker, [](const auto& all) { return !messages<Feedback>(all).empty(); });
  EXPECT_EQ(messages<Feedback>(back).size(), 1U);
}

TEST_F(Tls, ACertificateOfAnotherAuthorityIsRefusedByEitherSide) {
  const std::string home = installation("home"), foreign = installation("foreign");
  const auto tracker = listen(home + "/tracker.pem");
  EXPECT_EQ(refusal(*tracker, home + "/renderer.pem"), "");
  EXPECT_TRUE(mentions(refusal(*tracker, foreign + "/renderer.pem"), "certificate"));
  // A client that does not check the server is told by the server all the same.
  const auto identity = read_tls_identity(foreign + "/renderer.pem");
  ASSERT_TRUE(identity);
  SSL_CTX_set_verify(identity->get(), SSL_VERIFY_NONE, nullptr);
  boost::asio::io_context io;
  boost::asio::ip::tcp::socket socket(io);
  socket.connect({boost::asio::ip::address_v4::loopback(), parse_address(tracker->address())->port});
  TlsStream stream(**identity, socket.native_handle(), TlsStream::End::client);
  std::array<std::uint8_t, 64> room{};
  ssize_t count = stream.read(room);
  while (count < 0 && errno == EAGAIN) {
    socket.wait(stream.waits_to_write() ? socket.wait_write : socket.wait_read);
    count = stream.read(room);
  }
  ASSERT_TRUE(stream.error()) << "the server did not say that it refuses";
  EXPECT_TRUE(mentions(stream.error()->message, "unknown ca")) << stream.error()->message;
}

TEST_F(Tls, AnExpiredCertificateIsRefused) {
  const std::string home = installation("home", days(0));  // valid until a moment ago
  const auto tracker = listen(home + "/tracker.pem");
  EXPECT_TRUE(mentions(refusal(*tracker, home + "/renderer.pem"), "expired"));
}

TEST_F(Tls, OneSideWithoutItIsToldSo) {
  const std::string home = installation("home");
  const auto secure = listen(home + "/tracker.pem");
  EXPECT_TRUE(mentions(refusal(*secure, ""), "--tls-file"));
  auto plain = listen_tcp("127.0.0.1:0", options_of(Role::tracker));
  ASSERT_TRUE(plain);
  EXPECT_TRUE(mentions(refusal(**plain, home + "/renderer.pem"), "--tls-file"));
}

// Versions that a client offers, with a good certificate: is it let in?
bool lets_in(const Endpoint& tracker, const std::string& tls_file, int newest) {
  const auto identity = read_tls_identity(tls_file);
  SSL_CTX_set_min_proto_version(identity->get(), 0);
  SSL_CTX_set_max_proto_version(identity->get(), newest);
  boost::asio::io_context io;
  boost::asio::ip::tcp::socket socket(io);
  socket.connect({boost::asio::ip::address_v4::loopback(), parse_address(tracker.address())->port});
  SSL* const ssl = SSL_new(identity->get());
  SSL_set_fd(ssl, socket.native_handle());
  const bool opened = SSL_connect(ssl) == 1;
  SSL_free(ssl);
  return opened;
}

TEST_F(Tls, OlderVersionsAreRefused) {
  const std::string home = installation("home");
  const auto tracker = listen(home + "/tracker.pem");
  EXPECT_TRUE(lets_in(*tracker, home + "/renderer.pem", TLS1_3_VERSION));
  EXPECT_FALSE(lets_in(*tracker, home + "/renderer.pem", TLS1_2_VERSION));
}

TEST_F(Tls, FilesThatCannotServeAreNamed) {
  const std::string home = installation("home");
  const auto problem = [&](const std::string& file) {
    auto tracker = listen_tcp("127.0.0.1:0", with(Role::tracker, file));
    return tracker ? std::string() : tracker.error().message;
  };
  EXPECT_EQ(problem(home + "/tracker.pem"), "");
  EXPECT_TRUE(mentions(problem(home + "/nobody.pem"), "vhp certificate"));
  std::filesystem::permissions(home + "/tracker.pem", std::filesystem::perms::all);
  EXPECT_TRUE(mentions(problem(home + "/tracker.pem"), "chmod 600"));
  std::filesystem::resize_file(home + "/renderer.pem", 300);  // the key, and half a certificate
  EXPECT_TRUE(mentions(problem(home + "/renderer.pem"), "no certificate"));
  EXPECT_FALSE(make_certificates(home, {"tracker"}, days(1))) << "a file was replaced";
  EXPECT_FALSE(make_certificates(home, {"../tracker"}, days(1)));
}

// More than the reader's queues hold: what TLS has taken from the socket must be read when there is room again.
TEST_F(Tls, AReaderThatRestsFindsEverythingInOrder) {
  constexpr int kPoses = 20'000;
  const std::string home = installation("home");
  LinkOptions server = with(Role::tracker, home + "/tracker.pem");
  LinkOptions client = with(Role::renderer, home + "/renderer.pem");
  server.lockstep = client.lockstep = true;
  auto tracker = listen_tcp("127.0.0.1:0", server);
  ASSERT_TRUE(tracker);
  auto renderer = connect_tcp((*tracker)->address(), client, 2 * kSecond);
  ASSERT_TRUE(renderer) << renderer.error().message;
  ASSERT_NE(joined(**tracker), 0U);
  PoseEstimate pose;
  for (int i = 0; i < kPoses; ++i) {
    pose.stamp.frame_id = static_cast<FrameId>(i);
    (*tracker)->broadcast(pose);
  }
  while ((*tracker)->stats().front().unacknowledged > kPoses / 4) static_cast<void>((*tracker)->receive(1'000'000));
  FrameId next = 0;
  for (int i = 0; i < 100 && next < kPoses; ++i) {
    for (const PoseEstimate& got : messages<PoseEstimate>((*renderer)->receive(kSecond / 10))) {
      ASSERT_EQ(got.stamp.frame_id, next++);
    }
  }
  EXPECT_EQ(next, static_cast<FrameId>(kPoses));
}

TEST_F(Tls, ALostLinkIsResumedAndNoCommandIsLost) {
  const std::string home = installation("home");
  const auto tracker = listen(home + "/tracker.pem");
  Relay relay(parse_address(tracker->address())->port);
  auto renderer = connect_tcp(relay.address(), with(Role::renderer, home + "/renderer.pem"), 2 * kSecond);
  ASSERT_TRUE(renderer) << renderer.error().message;
  const PeerId peer = joined(*tracker);
  std::vector<Inbound> got;
  for (std::uint64_t id = 1; id <= 40; ++id) {
    tracker->send(peer, say(id, "hello"));
    if (id % 10 == 0) relay.cut();
    for (Inbound& inbound : (*renderer)->receive(kSecond / 100)) got.push_back(std::move(inbound));
  }
  for (int i = 0; i < 100 && messages<Command>(got).size() < 40; ++i) {
    for (Inbound& inbound : (*renderer)->receive(kSecond / 10)) got.push_back(std::move(inbound));
  }
  const auto commands = messages<Command>(got);
  ASSERT_EQ(commands.size(), 40U);
  for (std::uint64_t id = 1; id <= 40; ++id) EXPECT_EQ(commands[id - 1].id, id);
}

}  // namespace
}  // namespace counterpart
