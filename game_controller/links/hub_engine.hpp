// Our player as a Hub 2 engine: for every program that speaks to Scan.
#pragma once

#include <iosfwd>

namespace counterpart {

class EndgameTables;

// Reads commands until `quit` or the end of input; searches on a thread of its own, so that `stop`, `ping` and
// `ponder-hit` are heard at once.
// endgames: must outlive the engine; nullptr: it plays without.
void run_hub_engine(std::istream& in, std::ostream& out, const EndgameTables* endgames = nullptr);

}  // namespace counterpart
