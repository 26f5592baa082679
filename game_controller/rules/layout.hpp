// Squares as bits. One bit that is no square follows every two rows, so that a step in each of the four directions is
// the same shift everywhere and a step off the side lands on such a bit (ghost squares; 54 bits for 10x10, 35 for 8x8).
#pragma once

#include <bit>
#include <cstdint>

namespace counterpart {

using Bits = std::uint64_t;

constexpr int bit_of_square(int square, int squares_a_side) {
  return square - 1 + (square - 1) / squares_a_side;
}

constexpr int square_of_bit(int bit, int squares_a_side) {
  return bit - bit / (squares_a_side + 1) + 1;
}

constexpr Bits one(int bit) {
  return Bits{1} << bit;
}

constexpr Bits square_mask(int square, int squares_a_side) {
  return one(bit_of_square(square, squares_a_side));
}

constexpr int lowest(Bits bits) {
  return std::countr_zero(bits);
}

// Positive: towards higher numbers (down the board), negative: towards lower ones.
template <int Step>
constexpr Bits shifted(Bits bits) {
  if constexpr (Step > 0) {
    return bits << Step;
  } else {
    return bits >> -Step;
  }
}

constexpr Bits row_mask(int row, int squares_a_side) {
  Bits bits = 0;
  const int per_row = squares_a_side / 2;
  for (int i = 0; i < per_row; ++i) bits |= square_mask(row * per_row + i + 1, squares_a_side);
  return bits;
}

constexpr Bits all_squares(int squares_a_side) {
  Bits bits = 0;
  for (int row = 0; row < squares_a_side; ++row) bits |= row_mask(row, squares_a_side);
  return bits;
}

template <int N>
struct Layout {
  static constexpr int down_left = N / 2;
  static constexpr int down_right = N / 2 + 1;
  static constexpr int up_left = -down_right;
  static constexpr int up_right = -down_left;
  static constexpr Bits all = all_squares(N);
  static constexpr Bits top = row_mask(0, N);
  static constexpr Bits bottom = row_mask(N - 1, N);
};

}  // namespace counterpart
