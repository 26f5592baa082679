// What stands on each square, from how it differs from the empty square round it: colour, and structure (rims, tops).
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "protocol/vocabulary/occupancy.hpp"
#include "tracker_server/pieces/board_view.hpp"

namespace counterpart {

// Two numbers and a colour for each square.
struct CellLook {
  bool seen = false;
  float difference = 0;  // grey levels: how far its middle is from the colour of its own corners
  float structure = 0;   // grey levels a sample: steepness within it
  float full = 0;        // 0..1: share of its whole area that differs from an empty square of its colour
  float glare = 0;       // 0..1: share of its middle that is burnt out
  Colour middle;         // median of its middle
  Colour ground;         // of its corners: the empty square
};

// How far the samples of empty squares are from their usual colour at most, by (row + col) % 2, in steps between the
// board's two colours. Learned from pictures without a hand: in one with an arm over half the board nothing is usual.
struct GroundTolerance {
  std::array<double, 2> steps{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
};

// played: (row + col) % 2 of the squares that carry pieces, where known: of most others only the ground is looked at.
std::vector<CellLook> look_at_cells(const BoardView& view, std::optional<int> played = std::nullopt,
                                    const GroundTolerance& most = {});

// How the empty squares of one colour look in a picture.
struct GroundLook {
  Colour usual;
  float tolerance = 0;  // a sample that is farther from it is something else
  bool known = false;   // false: too few of them are seen
};

// By (row + col) % 2.
std::array<GroundLook, 2> ground_looks(const BoardView& view, const std::vector<CellLook>& cells,
                                       const GroundTolerance& most = {});

// What was learned from a picture; kept, it steadies the next one.
struct BoardLook {
  int playable_parity = 1;  // (row + col) % 2 of the squares that carry pieces
  double threshold = 1;     // of the evidence for a piece
  bool two_colours = false;
  Colour dark_piece, light_piece;
};

struct Reading {
  std::vector<CellSight> cells;
  // For a piece; the threshold is the look's. Octaves above an empty square, or the calibration's score.
  std::vector<float> evidence;
  BoardLook look;
};

class SquareCalibration;

// What is known of the pieces before looking.
struct Foreknowledge {
  std::optional<int> playable_parity;              // otherwise the one that shows more pieces
  bool one_colour = false;                         // only one side's pieces are real: shades among them are shadows
  const SquareCalibration* calibration = nullptr;  // what was learned from squares whose contents were known
};

// How well the board can be seen in a picture, grey levels.
struct BoardLight {
  double step = 0;   // between the usual colours of light and dark squares
  double floor = 0;  // how busy a square on which nothing stands looks: noise and grain; 0: none of them is seen
};

BoardLight board_light(const std::vector<CellLook>& cells, int squares);

Reading read_appearance(const std::vector<CellLook>& cells, int squares, const Foreknowledge& known);

}  // namespace counterpart
