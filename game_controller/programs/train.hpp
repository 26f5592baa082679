// Learns the weights of the trained evaluation.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct TrainOptions {
  std::string out;                          // file for the weights; written after each round
  std::vector<int> games{4000, 8000, 8000};  // of each round: the first is played with the plain evaluation, each
                                             // later one with the weights learnt before it
  int depth = 3;
  int epochs = 12;
  std::uint64_t seed = 1;
};

// Progress goes to `log`. The same options give the same file.
[[nodiscard]] Result<void> train(const TrainOptions& options, std::ostream& log);

}  // namespace counterpart
