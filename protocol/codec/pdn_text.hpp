// The outer form of PDN 3.0, whoever knows the game: tags, lines of words, results.
// Source: https://pdn.fmjd.org.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "protocol/vocabulary/game.hpp"

namespace counterpart {

// One tag with its line's end; quotes are escaped, control characters become blanks.
std::string pdn_tag(const std::string& name, const std::string& value);

// "2-0", "0-2", "1-1", or "*" for a game that is not over.
std::string pdn_result(GameResult result);

// The tag GameType of "international", "brazilian" or "english"; its number stands before the first comma.
std::string pdn_game_type(std::string_view rules);

// Words of a move section in lines of at most 79 characters, longer words apart.
class PdnLines {
 public:
  void word(std::string word);
  void words(const std::string& text);  // at its blanks
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::size_t column_ = 0;
};

}  // namespace counterpart
