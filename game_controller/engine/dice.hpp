// Chance that is the same each time: splitmix64 (Steele, Lea, Flood 2014).
#pragma once

#include <cstdint>

namespace counterpart {

constexpr std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}

  // 0 .. sides - 1, sides > 0.
  int roll(int sides) {
    state_ += 0x9E3779B97F4A7C15u;
    return static_cast<int>(mixed(state_) % static_cast<std::uint64_t>(sides));
  }

 private:
  std::uint64_t state_;
};

}  // namespace counterpart
