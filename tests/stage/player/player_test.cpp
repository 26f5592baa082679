#include "stage/player/player.hpp"

#include <gtest/gtest.h>

#include "stage/player/moves.hpp"

namespace counterpart::stage {
namespace {

BoardState start_state(GamePhase phase, Side turn) {
  BoardState state;
  state.squares = std::string(20, 'b') + std::string(10, 'e') + std::string(20, 'w');
  state.phase = phase;
  state.turn = turn;
  return state;
}

// Lets so many seconds pass, at the camera's rate.
void wait(Player& player, World& world, double seconds) {
  for (int i = 0; i < seconds * 25; ++i) player.step(0.04, world);
}

bool at_rest(const World& world) {
  return world.hand.held_piece < 0 && (world.hand.pinch_B - resting_hand(world.board)).norm() < 1e-6;
}

TEST(Player, PlaysALegalMoveWhenItIsHisTurnAndOnlyThen) {
  World world = starting_world({});
  Player player({});
  const std::string before = occupancy_of(world);
  player.see(start_state(GamePhase::virtual_to_move, Side::light));
  wait(player, world, 3);
  EXPECT_EQ(occupancy_of(world), before);
  player.see(start_state(GamePhase::real_to_move, Side::dark));
  wait(player, world, 3.5);
  EXPECT_TRUE(at_rest(world));
  const std::string after = occupancy_of(world);
  EXPECT_NE(after, before);
  bool legal = false;
  for (const PlayerMove& move :
       legal_moves("international", start_state(GamePhase::real_to_move, Side::dark).squares, Side::dark)) {
    std::string expected = before;
    expected[static_cast<std::size_t>(move.path.front() - 1)] = 'e';
    expected[static_cast<std::size_t>(move.path.back() - 1)] = 'b';
    legal = legal || after == expected;
  }
  EXPECT_TRUE(legal) << after;
  wait(player, world, 5);
  EXPECT_EQ(occupancy_of(world), after) << "one move a turn";
}

TEST(Player, TakesOffWhatTheMirrorAsksFor) {
  World world = starting_world({});
  Player player({});
  BoardState state = start_state(GamePhase::waiting_for_removal, Side::light);
  state.to_remove = {14, 18};
  player.see(state);
  wait(player, world, 6);
  EXPECT_TRUE(at_rest(world));
  EXPECT_EQ(piece_on(world, 14), -1);
  EXPECT_EQ(piece_on(world, 18), -1);
  EXPECT_NE(piece_on(world, 13), -1);
  for (const RealPiece& piece : world.pieces) {
    if (piece.square == 0) {
      EXPECT_LT(piece.p_B.x(), -0.23) << "beside the board, not on it";
    }
  }
}

TEST(Player, PutsAnIllegalMoveBackAndPlaysALegalOne) {
  PlayerOptions options;
  options.illegal_moves = {{1, IllegalKind::too_far}};
  World world = starting_world({});
  Player player(options);
  const std::string before = occupancy_of(world);
  player.see(start_state(GamePhase::real_to_move, Side::dark));
  wait(player, world, 3);
  const std::string illegal = occupancy_of(world);
  EXPECT_NE(illegal, before);
  EXPECT_NE(illegal.substr(25, 5), "eeeee") << "two rows ahead";
  player.see(start_state(GamePhase::illegal, Side::dark));
  wait(player, world, 4);
  EXPECT_EQ(occupancy_of(world), before);
  player.see(start_state(GamePhase::real_to_move, Side::dark));
  wait(player, world, 3);
  EXPECT_EQ(occupancy_of(world).substr(25, 5), "eeeee");
  EXPECT_NE(occupancy_of(world), before);
}

TEST(Player, SetsUpWhatIsMissing) {
  World world = starting_world({});
  Player player({});
  world.pieces[3].square = 0;
  world.pieces[3].p_B = place_beside_board(world.board, 0);
  player.see(start_state(GamePhase::setting_up, Side::light));
  wait(player, world, 5);
  EXPECT_EQ(occupancy_of(world), std::string(20, 'b') + std::string(30, 'e'));
}

TEST(Player, CapturesBecauseHeMust) {
  World world = starting_world({});
  Player player({});
  BoardState state = start_state(GamePhase::real_to_move, Side::dark);
  state.squares[24 - 1] = 'w';  // in front of 19 and 20, with 28, 29 and 30 free behind it
  player.see(state);
  wait(player, world, 4);
  const std::string after = occupancy_of(world);
  EXPECT_EQ(after.substr(25, 5).find('b') != std::string::npos, true) << after;
}

TEST(Player, TheHandMovesSmoothly) {
  World world = starting_world({});
  PlayerOptions options;
  options.practise = true;
  Player player(options);
  Eigen::Vector3d last = world.hand.pinch_B;
  for (int i = 0; i < 250; ++i) {
    player.step(0.04, world);
    EXPECT_LT((world.hand.pinch_B - last).norm(), 0.08) << "2 m/s is fast for a hand";
    last = world.hand.pinch_B;
  }
}

}  // namespace
}  // namespace counterpart::stage
