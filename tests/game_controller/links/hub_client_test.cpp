#include "game_controller/links/hub_client.hpp"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "game_controller/engine/opponent.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"

namespace counterpart {
namespace {

// An engine in a line of shell: introduces itself, then does `go` at each search.
std::string engine(const std::string& go) {
  return "while read -r c rest; do case $c in hub) echo 'id name=Shell version=1'; echo wait;; init) echo ready;; "
         "quit) exit;; go) " +
         go + ";; esac; done";
}

const Position start = start_position(international_rules);

TEST(HubClient, asks_and_reads_the_answer) {
  auto client =
      HubClient::start(engine("echo 'info depth=3 score=0.25 pv=\"32-28 19-23 99-1\"'; echo 'done move=32-28'"));
  ASSERT_TRUE(client) << client.error().message;
  EXPECT_EQ(client->name(), "Shell");
  for (int i = 0; i < 3; ++i) {
    const auto answer = client->ask(start, 0.1);
    ASSERT_TRUE(answer) << answer.error().message;
    EXPECT_EQ(hub_text(international_rules, answer->move), "32-28");
    EXPECT_DOUBLE_EQ(answer->score, 0.25);
    EXPECT_EQ(answer->line.size(), 2u);
  }
}

TEST(HubClient, bad_engines_fail_with_a_sentence) {
  EXPECT_FALSE(HubClient::start("exit 0", 2));
  EXPECT_FALSE(HubClient::start("sleep 20", 0.2));
  EXPECT_FALSE(HubClient::start("/nonexistent/engine", 2));
  for (const char* go : {"echo 'done move=1-50'", "echo 'done'", "exit 3", "true", "echo 'error message=no'"}) {
    auto client = HubClient::start(engine(go));
    ASSERT_TRUE(client);
    EXPECT_FALSE(client->ask(start, 0)) << go;
  }
}

// Asked something newer while the engine thinks, it must not take the old answer for the new one.
TEST(HubClient, is_stopped_before_it_is_asked_again) {
  auto client = HubClient::start(engine("read -r c; [ $c = stop ] && echo 'done move=31-27'"));
  ASSERT_TRUE(client);
  const auto dropped = client->ask(start, 5, [] { return true; });
  ASSERT_FALSE(dropped);
  EXPECT_EQ(dropped.error().code, ErrorCode::refused);
}

TEST(Opponent, may_be_a_hub_engine) {
  OpponentOptions options;
  options.lockstep = true;
  options.mind = "hub:" + engine("echo 'done move=32-28'");
  auto opponent = make_opponent(options);
  ASSERT_TRUE(opponent) << opponent.error().message;
  (*opponent)->think("W:W31-50:B1-20");
  EXPECT_EQ((*(*opponent)->poll())->move, "32-28");
  (*opponent)->think("B:W31-50:B1-20");  // there its move is illegal
  const auto resigned = **(*opponent)->poll();
  EXPECT_EQ(resigned.move, opponent_resigns);
  EXPECT_NE(resigned.note.find("illegal"), std::string::npos);
  options.mind = "nobody";
  EXPECT_FALSE(make_opponent(options));
}

}  // namespace
}  // namespace counterpart
