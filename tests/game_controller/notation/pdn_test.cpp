#include <gtest/gtest.h>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/pdn_read.hpp"
#include "game_controller/notation/pdn_write.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

std::string rewritten(const std::string& text) {
  const auto games = read_pdn(text);
  if (!games) return games.error().message;
  std::string out;
  for (const PdnGame& game : *games) out += write_pdn(game) + "\n";
  return out;
}

TEST(ReadPdn, takes_what_people_write) {
  const std::string text =
      "\xEF\xBB\xBF% made by a program\n"
      "[White \"A \\\"x\\\" B\"]\n{Before} [Event \"Cup\"] [GameType \"20,W,10,10,N2,0\"]\n\n"
      "1. 32-28! (1. 33-28 {x) y} 18-23 (2. 1-2)) 1...  19 - 23 $5 2.28x19 14x23 {a\n b} ; the rest\n"
      "037-032 10-14 1/2-1/2 {after}\n";
  const auto games = read_pdn(text);
  ASSERT_TRUE(games) << games.error().message;
  ASSERT_EQ(games->size(), 1u);
  const PdnGame& game = games->front();
  EXPECT_EQ(game.tag("White"), "A \"x\" B");
  EXPECT_EQ(game.result, GameResult::draw);
  EXPECT_EQ(game.record.moves().size(), 6u);
  ASSERT_EQ(game.remarks.size(), 6u);
  EXPECT_EQ(game.remarks[1].text, "$1");
  EXPECT_EQ(game.remarks[2].kind, RemarkKind::variation);
  EXPECT_EQ(game.remarks[2].text, "(1. 33-28 {x) y} 18-23 (2. 1-2))");
  EXPECT_EQ(game.remarks[4].text, "a b");
  EXPECT_EQ(rewritten(rewritten(text)), rewritten(text));
  EXPECT_NE(rewritten(text).find("1... 19-23"), std::string::npos);
}

TEST(ReadPdn, several_games_set_ups_and_other_rules) {
  const auto games = read_pdn(
      "[Event \"1\"] /FEN \"B:W28:B22,7.\"/ 1... 22x33 * [Event \"2\"][FEN \"W:W31:B10\"] 31-27 2-0\n"
      "[GameType \"21\"] 1. 11-15 23-19 0-1 [GameType \"26\"] 1. 22-18 *");
  ASSERT_TRUE(games) << games.error().message;
  ASSERT_EQ(games->size(), 4u);
  EXPECT_EQ(write_fen(international_rules, (*games)[0].record.position()), "W:W:B7,33");
  EXPECT_EQ((*games)[1].result, GameResult::light_wins);
  EXPECT_EQ((*games)[2].result, GameResult::dark_wins);
  EXPECT_EQ((*games)[2].record.rules().id, RulesId::english);
  EXPECT_EQ((*games)[3].record.rules().id, RulesId::brazilian);
  EXPECT_TRUE(read_pdn("")->empty());
}

TEST(ReadPdn, the_result_is_taken_from_the_tag_when_the_game_ends_with_a_star) {
  EXPECT_EQ(read_pdn("[Result \"0-2\"] 32-28 *")->front().result, GameResult::dark_wins);
}

TEST(ReadPdn, control_characters_are_blanks) {
  const auto games = read_pdn("1. 32-28 19-23 (\x1a) 2. 28x19 14x23 *\r\n\x1a");
  ASSERT_TRUE(games) << games.error().message;
  ASSERT_EQ(games->size(), 1u);
  EXPECT_EQ(games->front().record.moves().size(), 4u);
  ASSERT_EQ(games->front().remarks.size(), 1u);
  EXPECT_EQ(games->front().remarks[0].text, "()");
  const auto again = read_pdn(write_pdn(games->front()));
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->front().remarks, games->front().remarks);
}

TEST(ReadPdn, names_line_and_column) {
  const struct {
    const char* text;
    const char* place;
  } wrong[] = {
      {"[Event \"x\"]\n1. 32-28 19-24 2. 28-17 *", "line 2, column 19"},
      {"1. 32-28 {never", "line 1, column 10"},
      {"1. 32-28\n (1. 33-28", "line 2, column 2"},
      {"[Event x]", "line 1, column 8"},
      {"\n[FEN \"W:W99:B1\"] *", "line 2, column 6"},
      {"[GameType \"23\"] *", "line 1, column 11"},
      {"1. 32-28 ) *", "line 1, column 10"},
      {"[Event \"x", "line 1, column 8"},
      {"/FAN \"x\"/", "line 1, column 1"},
      {"1. e4 e5", "line 1, column 4"},
  };
  for (const auto& [text, place] : wrong) {
    const auto games = read_pdn(text);
    ASSERT_FALSE(games) << text;
    EXPECT_NE(games.error().message.find(place), std::string::npos) << text << ": " << games.error().message;
  }
}

// Games of random moves, written and read again, must be the same games.
TEST(ReadPdn, reads_what_is_written) {
  for (const Rules* rules : {&international_rules, &brazilian_rules, &english_rules}) {
    std::uint64_t random = 7;
    for (int n = 0; n < 20; ++n) {
      Record record(*rules, start_position(*rules));
      while (!record.ending() && record.moves().size() < 200) {
        MoveList legal;
        generate(*rules, record.position(), legal);
        random = random * 6364136223846793005u + 1442695040888963407u;
        record.play(legal[static_cast<int>((random >> 33) % static_cast<std::uint64_t>(legal.size()))]);
      }
      const std::string text = write_pdn(PdnTags{}, record, GameResult::draw);
      const auto games = read_pdn(text);
      ASSERT_TRUE(games) << games.error().message << "\n" << text;
      ASSERT_EQ(games->size(), 1u);
      EXPECT_EQ(games->front().record.moves(), record.moves());
      EXPECT_EQ(games->front().result, GameResult::draw);
      EXPECT_EQ(write_pdn(games->front()), text);
    }
  }
}

}  // namespace
}  // namespace counterpart
