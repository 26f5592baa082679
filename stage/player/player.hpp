// The simulated real player. He knows what a real one knows: his own pieces, and what the mirror shows him (the game's
// state). He never sees the truth of the camera, nor anything of the tracker.
#pragma once

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "protocol/vocabulary/game.hpp"
#include "stage/player/gesture.hpp"
#include "stage/player/moves.hpp"
#include "stage/player/world.hpp"

namespace counterpart::stage {

enum class IllegalKind : std::uint8_t {
  backwards = 1,    // a man one square back
  sideways = 2,     // a man two columns along its row
  too_far = 3,      // a man two rows ahead without a capture
  two_pieces = 4,   // two men moved in one turn
  wrong_piece = 5,  // a move without capture where one is due
};

struct IllegalMove {
  int at_move = 1;  // before the player's n-th legal move, counted from 1
  IllegalKind kind = IllegalKind::backwards;
};

// The hand lies on the board for a while.
struct HandRest {
  double at_s = 0;
  double for_s = 20;
  Eigen::Vector2d place_m{0, 0};  // in B
};

struct PlayerOptions {
  std::uint64_t seed = 1;
  double speed = 1;       // 2: twice as fast
  bool practise = false;  // no game: moves his pieces about by himself
  std::vector<IllegalMove> illegal_moves;
  std::vector<HandRest> rests;   // in order of time
  std::vector<int> knocks_over;  // before these of his legal moves, counted from 1, he knocks a piece over; rising
  double forgets_s = 0;          // takes off only one captured piece at once and leaves the next standing for so long
};

class Player {
 public:
  explicit Player(const PlayerOptions& options);

  // The mirror shows a new state.
  void see(const BoardState& state) { mirror_ = state; }

  // Decides when his hands are free, then lets them move for dt.
  void step(double dt_s, World& world);

  // For those who measure: what he meant to do, from the moment at which he begins it.
  const std::vector<PlayerMove>& moves() const { return moves_; }  // legal ones that he has not taken back
  const std::vector<IllegalKind>& illegal_moves() const { return illegal_; }

 private:
  void decide(World& world);
  void play(const BoardState& state, World& world);
  bool play_illegally(const World& world);
  std::vector<std::pair<int, int>> wrong_piece(const World& world) const;
  bool rest_hand(const World& world);
  void knock_over(const World& world, int beside);
  void practise(World& world);
  void make_board_show(const std::vector<int>& wanted, const World& world);
  void crown_kings(const BoardState& state, const World& world);
  void reach_for(const World& world, int piece);
  void carry(const World& world, int piece, const std::vector<int>& path);
  void take_off(const World& world, int piece);
  void withdraw(const World& world);
  void pause(const World& world, double seconds);
  double random(double from, double to);

  PlayerOptions options_;
  std::mt19937_64 random_;
  Gestures gestures_;
  std::optional<BoardState> mirror_;
  Eigen::Vector3d hand_after_{0, 0, 0};  // where the hand will be when all gestures are done
  double waited_s_ = 0;                  // since anything was done or the mirror asked for something
  int moves_made_ = 0;                   // those taken back are counted
  std::vector<PlayerMove> moves_;
  std::vector<IllegalKind> illegal_;
  int places_used_ = 0;
  std::size_t illegal_made_ = 0;
  std::size_t rests_made_ = 0;
  std::size_t knocks_made_ = 0;
  int taken_off_ = 0;
  double time_s_ = 0;
};

}  // namespace counterpart::stage
