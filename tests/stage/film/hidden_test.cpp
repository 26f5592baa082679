#include "stage/film/hidden.hpp"

#include <gtest/gtest.h>

namespace counterpart::stage {
namespace {

View from_above() {
  View view;
  view.intrinsics = {1, 720, 576, 610, 610, 359.5, 287.5, {}};
  view.X_CB = look_at_X_CB({0, 0.3, 0.9}, {0, 0, 0});
  return view;
}

TEST(Hidden, NothingHidesAnEmptyBoard) {
  World world = starting_world({});
  world.player_present = false;
  world.pieces.clear();
  const Hidden hidden = hidden_shares(world, from_above());
  EXPECT_EQ(hidden.surface_by_arm, 0);
  EXPECT_EQ(hidden.edges, 0);
}

TEST(Hidden, PiecesHideALittleOfTheGridAndTheArmMore) {
  World world = starting_world({});
  world.player_present = false;
  const double by_pieces = hidden_shares(world, from_above()).edges;
  EXPECT_GT(by_pieces, 0);
  EXPECT_LT(by_pieces, 0.15);
  world.player_present = true;
  world.hand.pinch_B = {0, -0.1, 0.01};
  const Hidden with_arm = hidden_shares(world, from_above());
  EXPECT_GT(with_arm.edges, by_pieces + 0.05);
  EXPECT_GT(with_arm.surface_by_arm, 0.05);
  EXPECT_LT(with_arm.surface_by_arm, 0.6);
}

TEST(Hidden, OutsideThePictureIsHidden) {
  World world = starting_world({});
  world.player_present = false;
  world.pieces.clear();
  View view = from_above();
  view.X_CB = look_at_X_CB({5, 0.3, 0.9}, {9, 0, 0});
  EXPECT_NEAR(hidden_shares(world, view).edges, 1, 1e-9);
}

}  // namespace
}  // namespace counterpart::stage
