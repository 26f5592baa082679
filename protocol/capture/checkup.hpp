// Looks a capture over: is the file whole, and is what it tells?
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

struct Checkup {
  std::uint64_t messages = 0;
  std::vector<std::string> damage;    // of the file: a cut, a wrong checksum
  std::vector<std::string> findings;  // in what it tells: numbers that are missing, commands without an answer
};

[[nodiscard]] Result<Checkup> check_capture(const std::string& path);

struct Recovery {
  std::uint64_t messages = 0;     // whole ones, all in the new file
  std::uint64_t passed_over = 0;  // records that were damaged
  std::string problem;            // of the old file; empty: none
};

// Writes every whole message of a damaged capture into a new one and proves the result by reading it again.
[[nodiscard]] Result<Recovery> recover_capture(const std::string& damaged, const std::string& recovered);

// How two captures differ in what was said, stamps and the link's own messages apart; one sentence a difference, at
// most `most` of them.
[[nodiscard]] Result<std::vector<std::string>> compare_captures(const std::string& a, const std::string& b,
                                                                std::size_t most);

}  // namespace counterpart
