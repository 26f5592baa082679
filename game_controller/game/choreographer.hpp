// From what happens in the game to what the virtual human is told. Ids count on over restarts; what a command waits for
// is named by `after`, so that a lost or failed one never stops the rest.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "game_controller/rules/routes.hpp"
#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/command.hpp"
#include "protocol/vocabulary/game.hpp"

namespace counterpart {

class Choreographer {
 public:
  Choreographer(const BoardGeometry& board, std::uint64_t next_id) : board_(board), next_id_(next_id) {}

  std::uint64_t next_id() const { return next_id_; }

  // Everything told since the last call.
  std::vector<Command> take();

  // Ends what is final.
  void hear(const Feedback& feedback);

  // The human comes in and sits down; what was told before and has not ended is told again, with new ids.
  // Returns the new id of a command by its old one (0: it had ended).
  void enter();
  std::uint64_t current_id(std::uint64_t told_id) const;

  void watch_board();
  void watch_player();
  void think();
  void say(const std::string& code, const std::string& text);

  // Looks, reaches, carries along the route, lets go. Returns the id of the grasp. second_try: another hand and style.
  std::uint64_t move(const std::string& piece, const std::vector<int>& route, bool second_try);

  // Takes a piece somewhere else than a move does: off the board, or onto a man. Returns the id of the grasp.
  std::uint64_t carry(const std::string& piece, const Point3& to_B);

  // Points along the route of a move that the real player is asked to make for him. Returns the id of the pointing.
  std::uint64_t ask_to_move(const std::vector<int>& route, const std::string& text);

  void object(const std::string& code, const std::string& text, int square);    // an illegal move
  void point_at(int square, const std::string& code, const std::string& text);  // a piece to remove
  void conclude(bool won, bool drawn, const std::string& code, const std::string& text);

  // What is going on is given up.
  void stop();

 private:
  std::uint64_t tell(Action action, std::vector<std::uint64_t> after = {}, std::int64_t deadline_ms = 0);

  BoardGeometry board_;
  std::uint64_t next_id_;
  std::vector<Command> told_;         // since the last `take`
  std::vector<Command> outstanding_;  // told and not ended
  std::vector<std::pair<std::uint64_t, std::uint64_t>> renamed_;
};

}  // namespace counterpart
