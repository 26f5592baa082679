// A move as the rules count it: from, to and the captured pieces; routes that differ only in between are one move.
// The whole path is found by `routes` (routes.hpp).
#pragma once

#include <array>
#include <cassert>
#include <cstdint>

#include "game_controller/rules/layout.hpp"

namespace counterpart {

struct Move {  // members without initialisers on purpose: see MoveList
  Bits captured;
  std::uint8_t from;  // bit numbers, see layout.hpp
  std::uint8_t to;

  friend bool operator==(const Move&, const Move&) = default;
};

// Room for more moves than any position has been found to offer (fewer than 200); more are not listed.
class MoveList {
 public:
  static constexpr int capacity = 512;

  void add(const Move& move) {
    if (size_ < capacity) moves_[static_cast<std::size_t>(size_++)] = move;
  }
  void clear() { size_ = 0; }
  int size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Move& operator[](int i) const {
    assert(i >= 0 && i < size_);
    return moves_[static_cast<std::size_t>(i)];
  }
  Move* begin() { return moves_.data(); }
  Move* end() { return moves_.data() + size_; }
  const Move* begin() const { return moves_.data(); }
  const Move* end() const { return moves_.data() + size_; }

 private:
  int size_ = 0;
  std::array<Move, capacity> moves_;  // not initialised: a list is made at every node of a search
};

}  // namespace counterpart
