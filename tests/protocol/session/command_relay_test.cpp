#include "protocol/session/command_relay.hpp"

#include <gtest/gtest.h>

namespace counterpart {
namespace {

Command nod(std::uint64_t id, std::vector<std::uint64_t> after = {}) {
  Command command;
  command.id = id;
  command.action = Keyframe{"nod"};
  command.after = std::move(after);
  return command;
}

TEST(CommandRelay, TwoDirectorsSameIdsDoNotMeetAndEachHearsOfHisOwn) {
  CommandRelay relay(1000);
  const Command a = relay.forward(7, nod(1));
  const Command b = relay.forward(8, nod(1));
  EXPECT_NE(a.id, b.id);
  Feedback done;
  done.command_id = b.id;
  done.state = FeedbackState::finished;
  const auto answer = relay.answer(done);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->director, 8u);
  EXPECT_EQ(answer->feedback.command_id, 1u);
  EXPECT_EQ(answer->feedback.state, FeedbackState::finished);
}

TEST(CommandRelay, ChainsAndStopsFollowTheNewNumbers) {
  CommandRelay relay(1000);
  const Command first = relay.forward(7, nod(1));
  const Command second = relay.forward(7, nod(2, {1}));
  EXPECT_EQ(second.after, std::vector<std::uint64_t>{first.id});
  Command stop;
  stop.id = 3;
  stop.action = Stop{{2}};
  EXPECT_EQ(std::get<Stop>(relay.forward(7, stop).action).commands, std::vector<std::uint64_t>{second.id});
}

TEST(CommandRelay, ACommandSentTwiceKeepsItsNumber) {
  CommandRelay relay(1000);
  EXPECT_EQ(relay.forward(7, nod(5)).id, relay.forward(7, nod(5)).id);
}

TEST(CommandRelay, KnowsNothingOfOthersCommands) {
  CommandRelay relay(1000);
  relay.forward(7, nod(1));
  Feedback other;
  other.command_id = 1;
  EXPECT_FALSE(relay.answer(other));
  EXPECT_FALSE(relay.owns(1));
  EXPECT_TRUE(relay.owns(1000));
}

}  // namespace
}  // namespace counterpart
