// Games as PDN 3.0, read leniently: tags in any order, comments, variations, glyphs, set-ups, results of other
// conventions, move numbers anywhere or nowhere. What a game says beyond its moves is kept beside them.
#pragma once

#include <string_view>
#include <vector>

#include "game_controller/notation/pdn_game.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// All games of a text, each by the rules that its GameType names (international if it names none). Fails with line and
// column, what is wrong there, and in which game. At most 64 MiB, 100,000 games and 5,000 moves a game.
[[nodiscard]] Result<std::vector<PdnGame>> read_pdn(std::string_view text);

}  // namespace counterpart
