#include "game_controller/rules/generate.hpp"

#include <set>

#include <gtest/gtest.h>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/rules/routes.hpp"

namespace counterpart {
namespace {

std::vector<std::uint64_t> counts(const Rules& rules, const std::string& fen, int depth) {
  const auto position = fen.empty() ? start_position(rules) : *read_fen(rules, fen);
  std::vector<std::uint64_t> counts;
  for (int d = 1; d <= depth; ++d) counts.push_back(perft(rules, position, d));
  return counts;
}

// Published counts of international draughts from the start.
TEST(Perft, international_from_the_start) {
  EXPECT_EQ(counts(international_rules, "", 8),
            (std::vector<std::uint64_t>{9, 81, 658, 4265, 27117, 167140, 1049442, 6483961}));
}

TEST(Perft, positions_with_many_kings_and_captures) {
  EXPECT_EQ(counts(international_rules, "B:W6,9,10,11,20,21,22,23,30,K31,33,37,41,42,43,44,46:BK17,K24", 6),
            (std::vector<std::uint64_t>{14, 55, 1168, 5432, 87195, 629010}));
  EXPECT_EQ(counts(international_rules, "W:W25,27,28,30,32,33,34,35,37,38:B12,13,14,16,18,19,21,23,24,26", 9),
            (std::vector<std::uint64_t>{6, 12, 30, 73, 215, 590, 1944, 6269, 22369}));
  EXPECT_EQ(counts(international_rules, "W:W6,7,8,9,10:B41,42,43,44,45", 6),
            (std::vector<std::uint64_t>{9, 81, 795, 7578, 86351, 936311}));
  EXPECT_EQ(counts(international_rules,
                   "W:WK31,K32,K33,K34,K35,K36,K37,K38,K39,K40,K41,K42,K43,K44,K45,K46,K47,K48,K49,K50:BK1,K2,K3,K4,K5,"
                   "K6,K7,K8,K9,K10,K11,K12,K13,K14,K15,K16,K17,K18,K19,K20",
                   6),
            (std::vector<std::uint64_t>{17, 79, 352, 1399, 7062, 37589}));
}

// Counts known for these games (Aart Bik's tables for English draughts; Brazilian recounted with plain Python rules).
TEST(Perft, other_rules_from_the_start) {
  EXPECT_EQ(counts(english_rules, "", 8), (std::vector<std::uint64_t>{7, 49, 302, 1469, 7361, 36768, 179740, 845931}));
  EXPECT_EQ(counts(brazilian_rules, "", 7), (std::vector<std::uint64_t>{7, 49, 302, 1469, 7473, 37628, 187302}));
}

std::set<std::string> ends(const std::string& fen) {
  const Position position = *read_fen(international_rules, fen);
  MoveList moves;
  generate(international_rules, position, moves);
  std::set<std::string> texts;
  for (const Move& move : moves) texts.insert(pdn_text(international_rules, position, move));
  return texts;
}

// FMJD Annex 1; the articles are named by the cases.
TEST(Articles, men_step_forwards) {  // 3.4
  EXPECT_EQ(ends("W:W28:B"), (std::set<std::string>{"28-22", "28-23"}));
  EXPECT_EQ(ends("B:W:B13"), (std::set<std::string>{"13-18", "13-19"}));
}
TEST(Articles, kings_fly) {  // 3.9
  EXPECT_EQ(ends("B:W:BK1"),
            (std::set<std::string>{"1-12", "1-18", "1-23", "1-29", "1-34", "1-40", "1-45", "1-6", "1-7"}));
}
TEST(Articles, capture_is_compulsory) {  // 4.2
  EXPECT_EQ(ends("W:W28,32:B23"), (std::set<std::string>{"28x19"}));
}
TEST(Articles, kings_choose_their_landing) {  // 4.3, 4.6
  EXPECT_EQ(ends("W:WK46:B23"), (std::set<std::string>{"46x10", "46x14", "46x19", "46x5"}));
  EXPECT_EQ(ends("W:WK47:B9,12,33"), (std::set<std::string>{"47x17", "47x21", "47x26"}));
}
TEST(Articles, several_pieces_at_once) {  // 4.5
  EXPECT_EQ(ends("W:W15:B8,19,20"), (std::set<std::string>{"15x2"}));
}
TEST(Articles, captured_pieces_stay_until_the_end) {  // 4.8
  EXPECT_EQ(ends("W:WK41,49:B9,10,12,19,38"), (std::set<std::string>{"41x43"}));
}

TEST(Articles, a_man_passing_the_far_row_is_not_crowned) {  // 4.15
  const Position p = *read_fen(international_rules, "W:W15:B8,10,20,9");
  MoveList moves;
  generate(international_rules, p, moves);
  for (const Move& move : moves) {
    const Position q = after(international_rules, p, move);
    EXPECT_EQ((q.kings & one(move.to)) != 0, square_of_bit(move.to, 10) <= 5);
  }
}

TEST(English, men_capture_forwards_and_any_capture_may_be_chosen) {
  const Position p = *read_fen(english_rules, "B:W15,16,23:B11,12");
  MoveList moves;
  generate(english_rules, p, moves);
  for (const Move& move : moves) EXPECT_GT(move.to, move.from);
  EXPECT_GE(moves.size(), 2);
}

// Whatever route is listed ends where the move ends and takes what it takes.
TEST(Routes, agree_with_their_moves) {
  const Position p = *read_fen(international_rules, "B:W6,9,10,11,20,21,22,23,30,K31,33,37,41,42,43,44,46:BK17,K24");
  MoveList moves;
  generate(international_rules, p, moves);
  for (const Move& move : moves) {
    const auto ways = routes(international_rules, p, move);
    ASSERT_FALSE(ways.empty());
    for (const Route& way : ways) {
      EXPECT_EQ(bits_of_squares(way.captured, 10), move.captured);
      EXPECT_EQ(way.squares.size(), way.captured.size() + 1);
      EXPECT_TRUE(way.complete);
    }
  }
}

}  // namespace
}  // namespace counterpart
