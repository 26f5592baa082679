#include <thread>

#include <gtest/gtest.h>

#include "game_controller/engine/opponent.hpp"
#include "game_controller/links/dxp_game.hpp"
#include "game_controller/links/dxp_message.hpp"
#include "game_controller/links/dxp_partner.hpp"
#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

std::string name_field(std::string name) {
  name.resize(32, ' ');
  return name;
}

TEST(DxpMessage, reads_and_writes_the_published_layouts) {
  const std::vector<std::string> layouts{
      "M0012061100",
      "M001205250422122320",
      "E10",
      "E01",
      "CHello there",
      "B005Z",
      "K1",
      "R01" + name_field("Scan") + "W060000A",
      "R01" + name_field("x y") + "Z005075BZ" + std::string(20, 'z') + std::string(29, 'e') + "W",
      "A" + name_field("Dam") + "0",
  };
  for (const std::string& text : layouts) {
    const auto message = read_dxp(text);
    ASSERT_TRUE(message) << text << ": " << message.error().message;
    EXPECT_EQ(write_dxp(*message), text);
  }
  const auto move = std::get<DxpMove>(*read_dxp("M001205250422122320"));
  EXPECT_EQ(move.seconds, 12);
  EXPECT_EQ(move.from, 5);
  EXPECT_EQ(move.to, 25);
  EXPECT_EQ(move.captured, (std::vector<int>{22, 12, 23, 20}));
  EXPECT_EQ(
      std::get<DxpGameRequest>(*read_dxp("R01" + name_field("a") + "W001002BZ" + std::string(49, 'z') + "Z")).position,
      "B" + std::string(49, 'b') + "B");
}

TEST(DxpMessage, refuses_the_rest_and_names_the_column) {
  for (const std::string text :
       {"", "X", "M001206110", "M00120611002", "M00120611 0", "E1", "E123", "B005X", "M0012061121", "R01short", "K"}) {
    EXPECT_FALSE(read_dxp(text)) << text;
  }
  EXPECT_FALSE(read_dxp("C" + std::string(127, 'x')));
  EXPECT_NE(read_dxp("M00120x1100").error().message.find("column 7"), std::string::npos);
}

DxpPlayer random_player(std::uint64_t seed) {
  DxpPlayer player;
  player.choose = [seed](const Record& record, int, int) mutable {
    MoveList legal;
    generate(record.rules(), record.position(), legal);
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return legal[static_cast<int>((seed >> 33) % static_cast<std::uint64_t>(legal.size()))];
  };
  player.patience_s = 20;
  return player;
}

// Both ends of real connections on this machine.
struct Ends {
  Channel asking;
  Channel asked;

  Ends() {
    auto listener = Listener::open("127.0.0.1:0");
    if (!listener) return;
    std::thread knock([&] {
      auto channel = connect_to("127.0.0.1:" + std::to_string(listener->port()), 5);
      if (channel) asking = std::move(*channel);
    });
    auto channel = listener->accept();
    knock.join();
    if (channel) asked = std::move(*channel);
  }
};

TEST(DxpGame, whole_games_are_played_and_both_sides_agree_on_them) {
  Ends ends;
  ASSERT_TRUE(ends.asking.is_open() && ends.asked.is_open());
  constexpr int games = 10;
  std::vector<DxpResult> theirs;
  std::thread follower([&] {
    const DxpPlayer player = random_player(2);
    for (int i = 0; i < games; ++i) {
      auto game = answer_dxp_game(ends.asked, player);
      if (game) theirs.push_back(std::move(*game));
    }
  });
  std::vector<DxpResult> ours;
  const DxpPlayer player = random_player(1);
  for (int i = 0; i < games; ++i) {
    DxpGameRequest request;
    request.name = "test";
    request.follower_side = i % 2 == 0 ? Side::dark : Side::light;
    if (i % 3 == 2)
      request.position = write_hub_position(international_rules, *read_fen(international_rules, "B:W28,K46:B1-20"));
    auto game = ask_for_dxp_game(ends.asking, request, player);
    if (game) ours.push_back(std::move(*game));
  }
  follower.join();
  ASSERT_EQ(ours.size(), static_cast<std::size_t>(games));
  ASSERT_EQ(theirs.size(), static_cast<std::size_t>(games));
  for (std::size_t i = 0; i < ours.size(); ++i) {
    EXPECT_EQ(ours[i].record.moves(), theirs[i].record.moves());
    EXPECT_EQ(ours[i].result, theirs[i].result);
    EXPECT_NE(ours[i].result, GameResult::open) << ours[i].why;
    EXPECT_FALSE(ours[i].stop);
  }
}

// What a bad peer does on its first turn, and how the game ends for it.
DxpResult game_against(const std::function<void(Channel&)>& peer, double patience_s = 5) {
  Ends ends;
  DxpPlayer player = random_player(3);
  player.patience_s = patience_s;
  std::thread bad([&] {
    const std::string request = "R01" + name_field("bad") + "Z010000A" + '\0';  // it plays light and moves first
    static_cast<void>(ends.asking.send(request));
    static_cast<void>(ends.asking.receive('\0', 200, 5));
    peer(ends.asking);
  });
  auto game = answer_dxp_game(ends.asked, player);
  bad.join();
  return game ? *game : DxpResult{Record(international_rules, start_position(international_rules))};
}

TEST(DxpGame, an_illegal_move_loses) {
  const auto game = game_against([](Channel& c) {
    static_cast<void>(c.send(std::string("M0000") + "0150" + "00" + '\0'));
    static_cast<void>(c.receive('\0', 200, 5));
    static_cast<void>(c.send(std::string("E00") + '\0'));
  });
  EXPECT_EQ(game.result, GameResult::dark_wins);
  EXPECT_EQ(game.why, "illegal_move");
  EXPECT_FALSE(game.stop);
}

TEST(DxpGame, death_silence_and_nonsense_lose) {
  EXPECT_EQ(game_against([](Channel& c) { c = Channel(); }).why, "closed");
  EXPECT_EQ(game_against([](Channel& c) { static_cast<void>(c.receive('\0', 200, 4)); }, 1).why, "timeout");
  const auto nonsense = game_against([](Channel& c) { static_cast<void>(c.send(std::string(5'000, 'x'))); });
  EXPECT_EQ(nonsense.why, "bad_message");
  EXPECT_EQ(nonsense.result, GameResult::dark_wins);
}

TEST(DxpGame, resigning_is_understood_and_answered) {
  std::string answer;
  const auto game = game_against([&](Channel& c) {
    static_cast<void>(c.send(std::string("CGood day") + '\0' + "E10" + '\0'));
    answer = c.receive('\0', 200, 5).value_or("none");
  });
  EXPECT_EQ(game.result, GameResult::dark_wins);
  EXPECT_EQ(game.why, "resigned");
  EXPECT_EQ(answer, "E00");
}

// Answers requests and plays at random until the other side is gone, like a program that waits for opponents.
class WaitingPlayer {
 public:
  WaitingPlayer() : listener_(Listener::open("127.0.0.1:0")) {
    if (listener_) thread_ = std::thread([this] { serve(); });
  }
  ~WaitingPlayer() { thread_.join(); }

  std::string address() const { return "127.0.0.1:" + std::to_string(listener_->port()); }

 private:
  void serve() {
    auto channel = listener_->accept();
    const DxpPlayer player = random_player(5);
    while (channel && answer_dxp_game(*channel, player)) {
    }
  }

  Result<Listener> listener_;
  std::thread thread_;
};

TEST(DxpPartner, plays_on_is_set_back_and_begins_anew) {
  WaitingPlayer waiting;
  auto partner = DxpPartner::connect(waiting.address(), 10);
  ASSERT_TRUE(partner);
  Record record(international_rules, start_position(international_rules));
  const auto ours = random_player(6);
  for (int i = 0; i < 10; ++i) {
    const auto move = partner->ask(record.position());
    ASSERT_TRUE(move) << move.error().message;
    record.play(*move);
    record.play(ours.choose(record, 0, 0));
  }
  record.undo();
  record.undo();  // the same question again, after it has moved: a new game from there
  EXPECT_TRUE(partner->ask(record.position()));
  EXPECT_TRUE(partner->ask(*read_fen(international_rules, "B:W28,K46:B1-20")));
}

TEST(DxpPartner, a_distant_player_may_be_the_opponent) {
  WaitingPlayer waiting;
  OpponentOptions options;
  options.lockstep = true;
  options.mind = "dxp:" + waiting.address();
  auto opponent = make_opponent(options);
  ASSERT_TRUE(opponent) << opponent.error().message;
  (*opponent)->think("W:W31-50:B1-20");
  const auto answer = **(*opponent)->poll();
  EXPECT_TRUE(read_move(international_rules, start_position(international_rules), answer.move)) << answer.move;
  options.mind = "dxp:127.0.0.1:1";
  EXPECT_FALSE(make_opponent(options));
}

TEST(Connecting, fails_with_a_sentence) {
  EXPECT_FALSE(connect_to("127.0.0.1:1", 1));
  EXPECT_FALSE(connect_to("127.0.0.1:nonsense", 1));
}

}  // namespace
}  // namespace counterpart
