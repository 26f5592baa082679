// One simulated game: a player on the stage against the system as it is, from the camera's picture to the game, in one
// process and in lockstep. The virtual human is not drawn: what he is told to do counts as done after a short while.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "stage/scenario/scenario.hpp"
#include "tracker_server/pieces/piece_reader.hpp"

namespace counterpart::bench {

struct PlayOptions {
  int plies = 30;          // the game is played until so many moves are made, of both sides
  double patience_s = 60;  // without any move for so long it is given up
  ReadingMethod method = ReadingMethod::appearance;
  std::function<bool()> stop = [] { return false; };
  std::ostream* log = nullptr;  // a line for whatever happens in the game, and for squares that are read wrongly
};

struct Played {
  std::string name;
  int plies = 0;  // of the record
  std::uint64_t frames = 0;
  bool equal = false;                // the record says what was really done
  std::string trouble;               // why not; or why the game ended before its time
  int wrong_commits = 0;             // moves of the real player that the game took for made and that were not
  int illegal_made = 0;              // illegal moves by the player
  int illegal_right = 0;             // of these, named with the right code
  int false_alarms = 0;              // objections to something that was in order
  int asked = 0;                     // the game had to ask which capture was meant
  std::vector<double> recognised_s;  // from the hand's leaving the board to the move's being recognised
  std::vector<float> reading_ms;     // squares read: a number a frame
  std::vector<float> observe_ms;     // the tracker's whole work on a frame
  double cpu_s = 0;
};

// The system is given the pictures, the lens and the board's sizes; the player is shown what the mirror would show him.
[[nodiscard]] Result<Played> play_game(const stage::Scenario& scenario, const PlayOptions& options);

}  // namespace counterpart::bench
