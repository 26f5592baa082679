// A camera's reading in the terms of the game: which squares hold a real piece, which cannot be told, and for how long
// that has been so.
#pragma once

#include <cstdint>
#include <vector>

#include "game_controller/rules/layout.hpp"
#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/occupancy.hpp"

namespace counterpart {

struct Reading {
  Bits occupied = 0;
  Bits light = 0;  // those of `occupied` that are light; only where colours are asked for
  Bits unknown = 0;
  std::vector<Cell> strays;  // pieces on squares that are not played on
  bool covered = false;      // a hand is over the board: nothing here counts

  friend bool operator==(const Reading&, const Reading&) = default;
};

// Whether nothing that is seen in both speaks against their being the same: squares flicker between seen and not.
bool agree(const Reading& a, const Reading& b);

// What is to be known of the pieces.
enum class Asked {
  places,   // one side's pieces are real: whatever stands there is one of them
  colours,  // both sides' are: what has no clear colour is unknown
};

// All unknown if the occupancy is of another board size.
Reading reading_of(const Occupancy& occupancy, int squares_a_side, Asked asked = Asked::places);

class SteadyReading {
 public:
  explicit SteadyReading(Asked asked = Asked::places) : asked_(asked) {}

  void see(const Occupancy& occupancy, int squares_a_side, std::int64_t now_ns);
  void forget() { seen_ = false; }

  const Reading& reading() const { return reading_; }

  // For how long nothing that was seen has changed, uncovered; -1 if the board is not seen. Time in which nobody looked
  // (the board was out of the picture) does not count.
  std::int64_t steady_ns(std::int64_t now_ns) const;

 private:
  Asked asked_;
  Reading reading_;
  Reading believed_;  // what cannot be told in the last reading is as it was seen before
  bool seen_ = false;
  std::int64_t since_ns_ = 0;   // time without sights left out
  std::int64_t looked_ns_ = 0;  // last sight
};

}  // namespace counterpart
