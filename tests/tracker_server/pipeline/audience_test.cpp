#include "tracker_server/pipeline/audience.hpp"

#include <functional>
#include <optional>

#include <gtest/gtest.h>

namespace counterpart {
namespace {

constexpr std::int64_t kTickNs = 10'000'000;

LinkOptions as(Role role) {
  LinkOptions options;
  options.role = role;
  options.software = "test";
  options.want_video = false;
  return options;
}

// A tracker's audience of one peer, over memory.
class AudienceOfOne : public testing::Test {
 protected:
  void seat(Role role) {
    auto [ours, theirs] = memory_link(as(Role::tracker), as(role));
    audience_ = std::make_unique<Audience>(std::move(ours));
    peer_ = std::move(theirs);
    pass([&] { return peer_id_ != 0; });
  }

  // Lets messages travel until the condition holds, two seconds at the most.
  void pass(const std::function<bool()>& enough) {
    for (int i = 0; i < 200 && !enough(); ++i) {
      audience_->hear(kTickNs / 2);
      for (Inbound& inbound : peer_->receive(kTickNs / 2)) {
        if (const auto* joined = std::get_if<PeerJoined>(&inbound)) peer_id_ = joined->peer;
        if (auto* received = std::get_if<Received>(&inbound)) got_.push_back(std::move(received->message));
      }
    }
  }

  template <class T>
  std::vector<T> got() const {
    std::vector<T> out;
    for (const Message& message : got_) {
      if (const auto* found = std::get_if<T>(&message)) out.push_back(*found);
    }
    return out;
  }

  std::unique_ptr<Audience> audience_;
  std::unique_ptr<Endpoint> peer_;
  PeerId peer_id_ = 0;
  std::vector<Message> got_;
};

TEST_F(AudienceOfOne, TheFirstRendererIsThePrimaryAndIsReportedOnceAsFresh) {
  seat(Role::renderer);
  pass([&] { return audience_->has_renderer(); });
  EXPECT_TRUE(audience_->has_renderer());
  EXPECT_TRUE(audience_->take_heard().renderer_joined);
  EXPECT_FALSE(audience_->take_heard().renderer_joined);
}

TEST_F(AudienceOfOne, AnObserverIsNoRenderer) {
  seat(Role::observer);
  pass([&] { return false; });
  EXPECT_FALSE(audience_->has_renderer());
}

TEST_F(AudienceOfOne, ASnapshotIsSentWhenItChangesAndNotAgain) {
  seat(Role::renderer);
  Scene scene;
  scene.revision = 7;
  for (int i = 0; i < 3; ++i) audience_->show_snapshot(scene);
  scene.revision = 8;
  audience_->show_snapshot(scene);
  pass([&] { return got<Scene>().size() >= 2; });
  ASSERT_EQ(got<Scene>().size(), 2u);
  EXPECT_EQ(got<Scene>()[1].revision, 8u);
}

TEST_F(AudienceOfOne, FeedbackOfThePrimaryReachesTheGameAndFrameDoneIsNoticed) {
  seat(Role::renderer);
  pass([&] { return audience_->has_renderer(); });
  EXPECT_FALSE(audience_->composited(5));
  Feedback feedback;
  feedback.command_id = 3;
  feedback.state = FeedbackState::finished;
  peer_->broadcast(feedback);
  peer_->broadcast(FrameDone{{5, 200}});
  pass([&] { return audience_->composited(5); });
  EXPECT_TRUE(audience_->composited(5));
  EXPECT_FALSE(audience_->composited(6));
  const Heard heard = audience_->take_heard();
  ASSERT_EQ(heard.feedback.size(), 1u);
  EXPECT_EQ(heard.feedback[0].command_id, 3u);
}

TEST_F(AudienceOfOne, AGoodbyeIsHeardEvenByAPeerThatIsTalking) {
  seat(Role::renderer);
  pass([&] { return audience_->has_renderer(); });
  for (FrameId frame = 0; frame < 200; ++frame) peer_->broadcast(FrameDone{{frame, 0}});
  std::optional<PeerLeft> left;
  const auto listen = [&] {
    for (const Inbound& inbound : peer_->receive(0)) {
      if (const auto* found = std::get_if<PeerLeft>(&inbound)) left = *found;
    }
  };
  audience_->say_goodbye("the camera has ended");
  for (int i = 0; i < 200 && !left; ++i) listen();
  audience_.reset();
  for (int i = 0; i < 200 && !left; ++i) listen();
  ASSERT_TRUE(left);
  EXPECT_TRUE(left->said_goodbye) << left->reason.message;
}

TEST_F(AudienceOfOne, ADirectorWithoutARendererHearsWhyNothingHappens) {
  seat(Role::director);
  Command nod;
  nod.id = 9;
  nod.action = Keyframe{"nod"};
  peer_->broadcast(nod);
  pass([&] { return !got<Feedback>().empty(); });
  ASSERT_EQ(got<Feedback>().size(), 1u);
  EXPECT_EQ(got<Feedback>()[0].command_id, 9u);
  EXPECT_EQ(got<Feedback>()[0].state, FeedbackState::failed);
  EXPECT_EQ(got<Feedback>()[0].code, "no_renderer");
}

}  // namespace
}  // namespace counterpart
