#include "stage/player/player.hpp"

#include <algorithm>

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

// In front of 19 and 20, with 28, 29 and 30 free behind it.
BoardState with_light_on_24() {
  BoardState state = start_state(GamePhase::real_to_move, Side::dark);
  state.squares[24 - 1] = 'w';
  return state;
}

TEST(Player, CapturesBecauseHeMust) {
  World world = starting_world({});
  Player player({});
  player.see(with_light_on_24());
  wait(player, world, 4);
  const std::string after = occupancy_of(world);
  EXPECT_EQ(after.substr(25, 5).find('b') != std::string::npos, true) << after;
}

// How the dark pieces stand when his first move, an illegal one, is made.
std::string after_first_move(const BoardState& state, IllegalKind kind, double wait_s) {
  PlayerOptions options;
  options.illegal_moves = {{1, kind}};
  World world = starting_world({});
  Player player(options);
  player.see(state);
  wait(player, world, wait_s);
  return occupancy_of(world);
}

// 24 stands so that 19 or 20 would take it by a move of two rows.
TEST(Player, AMoveTooFarIsNoCapture) {
  const BoardState state = with_light_on_24();
  const std::string after = after_first_move(state, IllegalKind::too_far, 3);
  for (const PlayerMove& move : legal_moves("international", state.squares, Side::dark)) {
    std::string legal = start_state(GamePhase::real_to_move, Side::dark).squares.substr(0, 20) + std::string(30, 'e');
    legal[static_cast<std::size_t>(move.path.front() - 1)] = 'e';
    legal[static_cast<std::size_t>(move.path.back() - 1)] = 'b';
    EXPECT_NE(after, legal);
  }
  EXPECT_NE(after.substr(25, 5), "eeeee") << "two rows ahead: " << after;
}

TEST(Player, MovesTheWrongPieceWhenACaptureIsDue) {
  const std::string after = after_first_move(with_light_on_24(), IllegalKind::wrong_piece, 4);
  EXPECT_EQ(std::count(after.begin(), after.end(), 'b'), 20);
  EXPECT_NE(after.substr(20, 5), "eeeee") << after;
  EXPECT_EQ(after.substr(25), std::string(25, 'e')) << "nobody has jumped: " << after;
}

TEST(Player, KnocksAPieceOverPutsItUpAndPlaysOn) {
  PlayerOptions options;
  options.knocks_over = {1};
  World world = starting_world({});
  Player player(options);
  player.see(start_state(GamePhase::real_to_move, Side::dark));
  int lying = 0;
  for (int i = 0; i < 10 * 25; ++i) {
    player.step(0.04, world);
    const std::string now = occupancy_of(world);
    if (world.hand.held_piece >= 0 || std::count(now.begin(), now.end(), 'b') == 20) continue;
    ++lying;
    EXPECT_EQ(std::count(now.begin(), now.end(), 'b'), 19);
    EXPECT_EQ(now.substr(20), std::string(30, 'e')) << "before his move";
  }
  EXPECT_GT(lying, 15) << "for more than half a second";
  EXPECT_TRUE(at_rest(world));
  const std::string after = occupancy_of(world);
  EXPECT_EQ(std::count(after.begin(), after.end(), 'b'), 20);
  EXPECT_EQ(std::count(after.begin() + 20, after.begin() + 25, 'b'), 1) << "one man has moved";
  for (const RealPiece& piece : world.pieces) EXPECT_EQ(piece.roll_rad, 0);
}

TEST(Player, ForgetsACapturedPieceForAWhile) {
  PlayerOptions options;
  options.forgets_s = 5;
  World world = starting_world({});
  Player player(options);
  BoardState state = start_state(GamePhase::waiting_for_removal, Side::light);
  state.to_remove = {14, 18};
  player.see(state);
  wait(player, world, 5);
  EXPECT_EQ((piece_on(world, 14) < 0) + (piece_on(world, 18) < 0), 1);
  wait(player, world, 10);
  EXPECT_EQ((piece_on(world, 14) < 0) + (piece_on(world, 18) < 0), 2);
}

TEST(Player, RestsHisHandOnTheBoard) {
  PlayerOptions options;
  options.practise = true;
  options.rests = {{0, 5, {0, 0.04}}};
  World world = starting_world({});
  Player player(options);
  wait(player, world, 3);
  EXPECT_LT(world.hand.pinch_B.head<2>().norm(), 0.06);
  wait(player, world, 2);
  EXPECT_LT(world.hand.pinch_B.head<2>().norm(), 0.06);
}

TEST(World, WhatLiesBesideTheBoardStaysWhenTheBoardIsMoved) {
  World world = starting_world({});
  world.pieces[0].square = 0;
  world.pieces[0].p_B = {-0.4, 0, -0.015};
  const Eigen::Vector3d standing = world.pieces[1].p_B;
  move_board(world, Eigen::Isometry3d(Eigen::Translation3d(0.05, 0, 0)));
  EXPECT_NEAR(world.pieces[0].p_B.x(), -0.45, 1e-12);
  EXPECT_EQ(world.pieces[1].p_B, standing);
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
