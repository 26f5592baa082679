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

TEST(Grasp, TheMeasureSeesAPieceThatStandsInTheWay) {
  const BoardGeometry board;
  const Eigen::Vector3f foot(0.1F, 0, 0);
  EXPECT_NEAR(distance_to_piece({0.1F, 0, 0.004F}, foot, board), -0.004F, 1e-6F) << "in its middle";
  EXPECT_NEAR(distance_to_piece({0.12F, 0, 0.004F}, foot, board), 0.004F, 1e-6F) << "beside it";
  EXPECT_NEAR(distance_to_piece({0.1F, 0, 0.018F}, foot, board), 0.010F, 1e-6F) << "above it";
}

}  // namespace
}  // namespace counterpart
