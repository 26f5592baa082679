// Our player as a Hub 2 engine: for every program that speaks to Scan.
#pragma once

#include <functional>
#include <iosfwd>

namespace counterpart {

class EndgameTables;

// Reads commands until `quit` or the end of input; searches on a thread of its own, so that `stop`, `ping` and
// `ponder-hit` are heard at once.
// `endgames` is asked for tables once, at `init`; they must outlive the engine. Empty: it plays without.
void run_hub_engine(std::istream& in, std::ostream& out, const std::function<const EndgameTables*()>& endgames = {});

}  // namespace counterpart
