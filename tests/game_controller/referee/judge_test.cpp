#include "game_controller/referee/judge.hpp"

#include <gtest/gtest.h>

#include "game_controller/notation/fen.hpp"
#include "game_controller/notation/move_text.hpp"
#include "game_controller/referee/sentences.hpp"
#include "game_controller/rules/generate.hpp"

namespace counterpart {
namespace {

const Rules& rules = international_rules;

struct Case {
  const char* before;
  const char* after;  // FEN of what is seen; its turn does not matter
  const char* reason;
};

class JudgeReasons : public testing::TestWithParam<Case> {};

TEST_P(JudgeReasons, are_found) {
  const Verdict verdict = judge(rules, *read_fen(rules, GetParam().before), *read_fen(rules, GetParam().after), {});
  EXPECT_FALSE(verdict.move);
  EXPECT_EQ(verdict.reason, GetParam().reason) << GetParam().before << " -> " << GetParam().after;
  EXPECT_NE(sentence(verdict.reason, verdict.squares), "That is not allowed.");
}

INSTANTIATE_TEST_SUITE_P(
    Judge, JudgeReasons,
    testing::Values(Case{"W:W31,32:B1", "W:W31,32:B1", "no_change"},                         //
                    Case{"W:W31,32:B1", "W:W31,32:B6", "not_your_turn"},                     //
                    Case{"W:W28:B22,1", "B:W:B33,1", "not_your_turn"},                       // the other side captured
                    Case{"W:W28,40:B22", "B:W28,35:B22", "must_capture"},                    //
                    Case{"W:W28,43:B22,39,30", "B:W17,43:B39,30", "not_maximum"},            // 43x34x25 takes two
                    Case{"W:W28:B22,12", "B:W17:B12", "capture_not_finished"},               //
                    Case{"W:W28:B22", "B:W17:B22", "captured_left_on_board"},                //
                    Case{"W:W28:B22,1", "B:W17:B22", "wrong_piece_removed"},                 //
                    Case{"W:W28:B22,1", "B:W17:B", "extra_piece_removed"},                   //
                    Case{"W:W28,50:B22", "B:W17:B", "extra_piece_removed"},                  // one of his own as well
                    Case{"W:W28:B1,2", "B:W28:B1", "piece_vanished"},                        //
                    Case{"W:W28:B1,2", "B:W22:B1", "piece_vanished"},                        // after a plain step
                    Case{"W:W28:B1", "B:W28,30:B1", "piece_appeared"},                       //
                    Case{"W:W28:B1", "B:W22:B1,2", "piece_appeared"},                        //
                    Case{"W:W28,29:B1", "B:W22,24:B1", "two_pieces_moved"},                  //
                    Case{"W:W28,29:B1", "B:W22,29:B6", "opponent_piece_moved"},              //
                    Case{"W:W28:B1", "B:W32:B1", "moved_backwards"},                         //
                    Case{"W:W28:B1", "B:W17:B1", "moved_too_far"},                           //
                    Case{"W:W28:B1", "B:W27:B1", "not_diagonal"},                            //
                    Case{"W:W28:B1", "B:W18:B1", "not_diagonal"},                            // two rows straight ahead
                    Case{"W:WK28,22:B1", "B:W22,K17:B1", "path_blocked"},                    //
                    Case{"W:WK46:B37,32,1", "B:WK23:B1", "path_blocked"},                    // over two in a row
                    Case{"W:W28,22:B1", "B:W22,17:B1", "jumped_own_piece"},                  //
                    Case{"W:W28,22:B1", "B:W17:B1", "jumped_own_piece"},                     // and took it off
                    Case{"W:WK47:B9,12,33", "B:WK8:B", "wrong_landing"},                     //
                    Case{"W:W28:B22,1", "B:W22:B1", "wrong_landing"},                        // took it as in chess
                    Case{"W:W8:B40", "B:W3:B40", "not_crowned"},                             //
                    Case{"W:W28:B1", "B:WK22:B1", "crowned_wrongly"},                        //
                    Case{"W:W28:B22", "B:WK17:B", "crowned_wrongly"},                        //
                    Case{"W:W28,40:B1", "B:W22,K40:B1", "crowned_wrongly"},                  // another man
                    Case{"W:WK41,49:B9,10,12,19,38", "B:WK43,49:B", "extra_piece_removed"},  //
                    Case{"W:W28,40:B22", "B:W28,40:B", "piece_vanished"}));

TEST(Judge, stray_pieces_come_first) {
  const Position before = *read_fen(rules, "W:W28,29:B1");
  EXPECT_EQ(judge(rules, before, *read_fen(rules, "B:W29:B1"), {{4, 4}}).reason, "light_square");
}

// Every legal move of a thousand positions is taken for just that move.
TEST(Judge, recognises_every_legal_move) {
  Position position = start_position(rules);
  std::uint64_t random = 1;
  int seen = 0;
  for (int ply = 0; ply < 1000; ++ply) {
    MoveList legal;
    generate(rules, position, legal);
    if (legal.empty()) {
      position = start_position(rules);
      continue;
    }
    for (const Move& move : legal) {
      const Verdict verdict = judge(rules, position, after(rules, position, move), {});
      ASSERT_TRUE(verdict.move) << write_fen(rules, position) << " " << hub_text(rules, move) << verdict.reason;
      EXPECT_EQ(after(rules, position, *verdict.move), after(rules, position, move));
      ++seen;
    }
    random = random * 6364136223846793005u + 1442695040888963407u;
    position =
        after(rules, position, legal[static_cast<int>((random >> 33) % static_cast<std::uint64_t>(legal.size()))]);
  }
  EXPECT_GT(seen, 3000);
}

TEST(JudgeOwn, sees_only_the_movers_pieces) {
  const Position before = *read_fen(rules, "B:W28,45:B22,7");
  EXPECT_TRUE(judge_own(rules, before, square_mask(33, 10) | square_mask(7, 10), {}).move);
  EXPECT_EQ(judge_own(rules, before, square_mask(22, 10) | square_mask(11, 10), {}).reason, "must_capture");
  EXPECT_EQ(judge_own(rules, before, square_mask(22, 10), {}).reason, "piece_vanished");
  EXPECT_EQ(judge_own(rules, before, before.dark, {}).reason, "no_change");
  EXPECT_EQ(judge_own(rules, before, before.dark, {{0, 0}}).reason, "light_square");
  EXPECT_EQ(judge_own(rules, before, before.dark | square_mask(50, 10), {}).reason, "piece_appeared");
  EXPECT_EQ(judge_own(rules, before, square_mask(28, 10) | square_mask(7, 10), {}).reason, "wrong_landing");
}

TEST(Sentences, name_squares_as_people_do) {
  EXPECT_EQ(listed({12}), "12");
  EXPECT_EQ(listed({12, 17}), "12 and 17");
  EXPECT_EQ(listed({12, 17, 21}), "12, 17 and 21");
  EXPECT_EQ(sentence("board_unclear", {12, 17}), "I cannot see squares 12 and 17.");
}

}  // namespace
}  // namespace counterpart
