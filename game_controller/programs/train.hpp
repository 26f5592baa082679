// Learns the weights of the trained evaluation.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct TrainOptions {
  std::string start;  // weights to go on from; empty: none, the first round is played with the plain evaluation
  std::string out;    // file for the weights; written after each round
  std::vector<int> games{6000, 8000};  // of each round; each is played with the weights learnt before it
  int depth = 4;
  int epochs = 4;
  std::uint64_t seed = 1;
};

// Progress goes to `log`. The same options give the same file.
[[nodiscard]] Result<void> train(const TrainOptions& options, std::ostream& log);

}  // namespace counterpart
