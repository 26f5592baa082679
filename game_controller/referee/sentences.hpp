// Codes as sentences that a ten-year-old understands. English; another language is another such function.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace counterpart {

// reason: a code of judge.hpp, or of the game: "remove_captured", "put_back", "which_capture", "virtual_piece_there",
// "thanks", "you_win", "i_win", "draw". legal: a move that may be named as an example.
std::string sentence(std::string_view reason, const std::vector<int>& squares,
                     const std::vector<std::string>& legal = {});

// What the real player is asked to do where the virtual player's pieces are real too. route: from, via ..., to.
std::string favour_sentence(const std::vector<int>& route, const std::vector<int>& captured);

// "12", "12 and 17", "12, 17 and 21"
std::string listed(const std::vector<int>& squares);

}  // namespace counterpart
