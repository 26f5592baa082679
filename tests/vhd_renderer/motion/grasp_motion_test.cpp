// The figures of a grasp, measured on the skin that is drawn (in full: tests/bench/measure_human reach carry clear).
#include "vhd_renderer/motion/grasp_motion.hpp"

#include "tests/vhd_renderer/motion/human_measures.hpp"

namespace counterpart {
namespace {

class EitherHand : public testing::TestWithParam<Hand> {};

TEST_P(EitherHand, ReachesEverySquareFromTheChair) {
  const GraspFigures f = measure_grasps(mannequin(), GetParam(), fifty_moves(), false);
  EXPECT_EQ(f.grasps, 50);
  EXPECT_EQ(f.failed, 0);
  EXPECT_LT(f.worst_gap_mm, 1.F);
  EXPECT_LT(f.worst_place_mm, 1e-3F);
}

TEST_P(EitherHand, CarriesThePieceBetweenItsFingers) {
  // Corner to corner, near and far.
  const GraspFigures f = measure_grasps(mannequin(), GetParam(), {{46, 5}, {5, 28}, {28, 50}, {50, 6}}, true);
  EXPECT_EQ(f.failed, 0);
  EXPECT_LT(f.deepest_mm, 1.F) << "fingers in the piece";
  for (const float gap : f.widest_gap_mm) EXPECT_LT(gap, 1.F) << "finger beside the piece";
  EXPECT_LT(f.below_board_mm, 1.F) << "fingers in the board";
}

INSTANTIATE_TEST_SUITE_P(Grasp, EitherHand, testing::Values(Hand::left, Hand::right));

TEST(Grasp, NoHandGoesThroughAnotherPieceOrTheTable) {
  const ClearanceFigures f = measure_clearance(mannequin(), 15, 5);
  EXPECT_EQ(f.failed, 0);
  EXPECT_LT(f.in_pieces_mm, 1.F) << f.where;
  EXPECT_LT(f.in_table_mm, 1.F) << f.where_in_table;
}

// Who is short comes up from his chair and bends over his other hand, which lies before the board.
TEST(Grasp, TheRestingHandMakesRoomForItsOwnersShoulder) {
  for (const float scale : {0.7F, 0.85F}) {
    const ClearanceFigures f = measure_clearance(scaled(mannequin(), scale), 12, 5);
    EXPECT_EQ(f.failed, 0) << scale;
    EXPECT_LT(f.in_pieces_mm, 1.F) << scale << ": " << f.where;
    EXPECT_LT(f.in_table_mm, 1.F) << scale << ": " << f.where_in_table;
  }
}

// Crowning: a lost piece from beside the board goes on top of a man among others.
TEST(Grasp, StacksAPieceOnAManAndTouchesNothingElse) {
  Scene scene = board_with({{"light_2", 2}, {"light_7", 7}, {"light_8", 8}});
  const BoardGeometry& board = scene.board;
  scene.pieces.push_back({"lost", Side::light, false, false, {0.29, -0.115, -board.thickness_m}});
  scene.pieces.push_back({"lost_too", Side::light, false, false, {0.33, -0.075, -board.thickness_m}});
  Rehearsal r;
  r.frame({}, &scene);
  r.take_seat("instant");
  Point3 on_top = centre_of_square_B(2, board);
  on_top[2] = board.piece_height_m;
  const Figure hands = flesh_of(r.figure, {"r_wrist", "r_thumb", "r_index", "r_middle", "r_ring", "r_pinky"});
  const std::vector<Eigen::Vector3f> others{r.piece("light_2"), r.piece("light_7"), r.piece("light_8"),
                                            r.piece("lost_too")};
  r.frame({grasp(1, "lost", {on_top}, Hand::right)});
  float deepest = 0;
  for (int i = 0; i < 300 && !r.ended(1); ++i) {
    r.frame();
    for (const Eigen::Vector3f& p : skin_places(hands, r)) {
      for (const Eigen::Vector3f& foot : others) deepest = std::max(deepest, -distance_to_piece(p, foot, board));
    }
  }
  ASSERT_EQ(r.said[1].back().state, FeedbackState::finished) << r.said[1].back().code;
  EXPECT_LT(deepest, 0.001F);
  EXPECT_NEAR(r.piece("lost").z(), board.piece_height_m, 1e-5);
  EXPECT_NEAR(r.piece("lost").x(), on_top[0], 1e-5);
  EXPECT_NEAR(r.piece("light_2").z(), 0, 1e-6) << "the man has not moved";
}

TEST(Grasp, TheMeasureSeesAPieceThatStandsInTheWay) {
  const BoardGeometry board;
  const Eigen::Vector3f foot(0.1F, 0, 0);
  EXPECT_NEAR(distance_to_piece({0.1F, 0, 0.004F}, foot, board), -0.004F, 1e-6F) << "in its middle";
  EXPECT_NEAR(distance_to_piece({0.12F, 0, 0.004F}, foot, board), 0.004F, 1e-6F) << "beside it";
  EXPECT_NEAR(distance_to_piece({0.1F, 0, 0.018F}, foot, board), 0.010F, 1e-6F) << "above it";
}

}  // namespace
}  // namespace counterpart
