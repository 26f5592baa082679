// What the camera says stands on the board: one reading per cell, no rules.
#pragma once

#include <cstdint>
#include <vector>

#include "protocol/vocabulary/stamp.hpp"

namespace counterpart {

enum class CellReading : std::uint8_t {
  empty = 1,
  dark = 2,
  light = 3,
  piece = 4,    // something stands there, its colour is not known
  unknown = 5,  // covered, glaring or undecided: an answer, not a guess
};

struct CellSight {
  CellReading reading = CellReading::unknown;
  float confidence = 0;  // 0..1

  friend bool operator==(const CellSight&, const CellSight&) = default;
};

struct Occupancy {
  FrameStamp stamp;
  int squares = 10;  // cells a side
  std::vector<CellSight>
      cells;                   // squares * squares, by rows; cells[row * squares + col]; rows as in board_geometry.hpp
  bool covered = false;        // a hand or a thing is over the board
  std::int64_t stable_ns = 0;  // for how long these readings have not changed and nothing moved

  friend bool operator==(const Occupancy&, const Occupancy&) = default;
};

}  // namespace counterpart
