// Games as PDN 3.0, written strictly.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "game_controller/notation/pdn_game.hpp"
#include "game_controller/rules/record.hpp"

namespace counterpart {

struct PdnTags {
  std::string event = "?";
  std::string site = "?";
  std::string date = "????.??.??";
  std::string round = "?";
  std::string light = "?";
  std::string dark = "?";
};

// Lines of at most 79 characters. A start other than the usual one is written as FEN tag.
std::string write_pdn(const PdnTags& tags, const Record& record, GameResult result);

// A game that was read, with all its tags and remarks.
std::string write_pdn(const PdnGame& game);

}  // namespace counterpart
