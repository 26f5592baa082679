// The referee on lines of JSON.
#pragma once

#include <iosfwd>
#include <string>

#include "game_controller/rules/rules.hpp"

namespace counterpart {

// In: {"before": FEN, "after": the squares in order as w b W B e, "light": [[row, column, piece] ...]}.
// Out: {"verdict":"legal","move"}, {"verdict":"illegal","reason","squares","say","legal"} or
// {"verdict":"error","message"}.
std::string judge_line(const Rules& rules, const std::string& line);

// One line out for each line in. False if a line could not be read.
bool judge_lines(const Rules& rules, std::istream& in, std::ostream& out);

}  // namespace counterpart
