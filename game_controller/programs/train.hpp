// Learns the weights of the trained evaluation: games of the engine with itself, and what follows from them.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct LessonOptions {
  std::string out;      // file of lessons; what it holds already is not played again
  std::string weights;  // that the games are played with; "plain": without any; empty: the built-in ones
  int games = 10'000;   // in the file in the end
  int depth = 4;        // plies that each move is thought about
  std::uint64_t seed = 1;
};

// Progress goes to `log`. The same options give the same file, in one run or in several.
[[nodiscard]] Result<void> play_lessons_to_file(const LessonOptions& options, std::ostream& log);

struct FitFilesOptions {
  std::vector<std::string> lessons;  // files
  std::string out;                   // file for the weights
  std::string start;                 // weights to go on from; empty: none
  int epochs = 4;
  double trust_in_search = 0.75;
};

[[nodiscard]] Result<void> fit_files(const FitFilesOptions& options, std::ostream& log);

}  // namespace counterpart
