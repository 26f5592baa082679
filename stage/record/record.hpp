// Does a game's record say what was really done on the board? Compares a PDN with the stage's truth.
#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/vocabulary/result.hpp"

namespace counterpart::stage {

struct RecordCheck {
  int plies = 0;        // in the record
  int real_moves = 0;   // by the real player, as the truth has them
  std::string trouble;  // where both part; empty: they agree

  bool agrees() const { return trouble.empty(); }
};

// How the real pieces stood, one entry for each time that something was done for good: a move, or captured pieces taken
// off (all that a capture takes at once). What was taken back, such as an illegal move or a piece knocked over and put
// up again, is left out. Letters as in Truth::occupancy, kings as men: a king is crowned some time after his move.
std::vector<std::string> lasting_changes(const std::vector<std::string>& occupancies);

// How the real pieces stood at one moment.
struct BoardMoment {
  std::int64_t capture_ns = 0;
  std::string occupancy;     // as Truth::occupancy
  bool holds_piece = false;  // one is in the hand and stands nowhere
};

// pdn: its last game is compared; the real player has the dark pieces. seen: in order of time. What was done less than
// three seconds before the last of them need not be in the record yet, and what the record's last move captured need
// not be off the board. Fails if the PDN cannot be read or is of another size of board.
[[nodiscard]] Result<RecordCheck> compare_record(std::string_view pdn, const std::vector<BoardMoment>& seen);

// The same with what `stage` writes as truth.jsonl; fails if that cannot be read.
[[nodiscard]] Result<RecordCheck> compare_record(std::string_view pdn, std::istream& truth);

}  // namespace counterpart::stage
