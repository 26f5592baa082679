// The state of the game and what happens in it, as codes with their data. Sentences are made where they are read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace counterpart {

enum class Side : std::uint8_t { light = 1, dark = 2 };

constexpr Side other(Side side) {
  return side == Side::light ? Side::dark : Side::light;
}

enum class GamePhase : std::uint8_t {
  setting_up = 1,  // the real pieces do not stand as the position says yet
  real_to_move = 2,
  virtual_to_move = 3,      // thinking, or the hand is on its way
  waiting_for_removal = 4,  // the real player has to take his captured pieces off the board
  illegal = 5,              // the board shows something that is not legal; waiting for it to be put right
  paused = 6,
  over = 7,
};

enum class GameResult : std::uint8_t { open = 1, light_wins = 2, dark_wins = 3, draw = 4 };

// A snapshot: what a client that joins late gets.
struct BoardState {
  std::uint64_t revision = 0;           // grows with every change
  std::string rules = "international";  // "international", "brazilian", "english"
  std::string squares;                  // one of "wbWBe" a square, in order of number
  Side turn = Side::light;
  Side virtual_side = Side::light;
  GamePhase phase = GamePhase::setting_up;
  GameResult result = GameResult::open;
  std::vector<std::string> moves;  // whole game so far, written as in PDN: "32-28", "28x19"
  std::vector<int> to_remove;      // squares whose real pieces are to be taken off
  std::string start_fen;           // where the game started; empty: the usual start

  friend bool operator==(const BoardState&, const BoardState&) = default;
};

enum class EventKind : std::uint8_t {
  game_started = 1,
  move = 2,                 // side, move, squares: path, captured
  illegal_move = 3,         // code, squares, legal
  captured = 4,             // side that lost them, captured
  promoted = 5,             // side, squares
  waiting_for_removal = 6,  // captured: the squares to clear
  removal_done = 7,
  turn = 8,             // side that is to move now
  board_unclear = 9,    // squares that cannot be seen
  board_restored = 10,  // after illegal_move: put back, or made legal
  set_up_wrong = 11,    // squares that differ from the position
  game_over = 12,       // result, code
  undone = 13,          // move taken back
};

struct GameEvent {
  std::uint64_t id = 0;
  EventKind kind = EventKind::game_started;
  Side side = Side::light;
  std::string code;                // e.g. "must_capture", "no_moves", "resigned"; empty if there is nothing to add
  std::string move;                // as in PDN, whole path where ambiguous
  std::vector<int> squares;        // what the event is about, in order (for a move: from, via ..., to)
  std::vector<int> captured;       // squares of captured pieces
  std::vector<std::string> legal;  // with illegal_move: at least one legal move
  GameResult result = GameResult::open;
  std::int64_t stamp_ns = 0;  // capture time of the frame that decided it

  friend bool operator==(const GameEvent&, const GameEvent&) = default;
};

// What a person asks of the game: from the page, the CLI or a script.
enum class ControlKind : std::uint8_t {
  new_game = 1,  // text: FEN or empty
  undo = 2,
  resign = 3,
  pause = 4,
  resume = 5,
  read_again = 6,  // forget the last reading and look afresh
  it_was = 7,      // text: the move that was really made
  level = 8,       // number: 1..8
  swap_sides = 9,
  corners = 10,  // corners_px: where the board is, any order
  hint = 11,
  quit = 12,
};

struct Control {
  std::uint64_t id = 0;
  ControlKind kind = ControlKind::pause;
  std::string text;
  std::int32_t number = 0;
  std::vector<double> corners_px;  // x0, y0 ... x3, y3

  friend bool operator==(const Control&, const Control&) = default;
};

}  // namespace counterpart
