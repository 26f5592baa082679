#include "game_controller/game/reading.hpp"

#include <algorithm>

namespace counterpart {
namespace {

constexpr std::int64_t longest_between_ns = 250'000'000;  // two sights of one look; a slow camera takes its time
constexpr std::int64_t absence_ns = 1'000'000'000;        // after so long anything may have happened

}  // namespace

Reading reading_of(const Occupancy& occupancy, int squares_a_side, Asked asked) {
  Reading reading;
  reading.covered = occupancy.covered;
  const auto cells = static_cast<std::size_t>(squares_a_side) * static_cast<std::size_t>(squares_a_side);
  if (occupancy.squares != squares_a_side || occupancy.cells.size() != cells) {
    reading.unknown = all_squares(squares_a_side);
    return reading;
  }
  for (int row = 0; row < squares_a_side; ++row) {
    for (int col = 0; col < squares_a_side; ++col) {
      const CellReading seen = occupancy.cells[static_cast<std::size_t>(row * squares_a_side + col)].reading;
      const bool piece = seen == CellReading::dark || seen == CellReading::light || seen == CellReading::piece;
      const auto square = square_of_cell({row, col}, squares_a_side);
      if (!square) {
        if (piece) reading.strays.push_back({row, col});
      } else if (piece && (asked == Asked::places || seen != CellReading::piece)) {
        reading.occupied |= square_mask(*square, squares_a_side);
        if (asked == Asked::colours && seen == CellReading::light)
          reading.light |= square_mask(*square, squares_a_side);
      } else if (seen != CellReading::empty) {
        reading.unknown |= square_mask(*square, squares_a_side);
      }
    }
  }
  return reading;
}

bool agree(const Reading& a, const Reading& b) {
  const Bits differ = (a.occupied ^ b.occupied) | (a.light ^ b.light);
  return a.covered == b.covered && a.strays == b.strays && (differ & ~a.unknown & ~b.unknown) == 0;
}

void SteadyReading::see(const Occupancy& occupancy, int squares_a_side, std::int64_t now_ns) {
  Reading reading = reading_of(occupancy, squares_a_side, asked_);
  if (!seen_ || !agree(reading, believed_) || now_ns - looked_ns_ > absence_ns) {
    // The reader may know better than we how long nothing has changed (it sees every frame).
    since_ns_ = now_ns - (reading.covered ? 0 : std::max<std::int64_t>(occupancy.stable_ns, 0));
    believed_ = reading;
    seen_ = true;
  } else {
    since_ns_ += std::max<std::int64_t>(0, now_ns - looked_ns_ - longest_between_ns);
  }
  believed_.occupied = (reading.occupied & ~reading.unknown) | (believed_.occupied & reading.unknown);
  believed_.light = (reading.light & ~reading.unknown) | (believed_.light & reading.unknown);
  believed_.unknown &= reading.unknown;
  reading_ = std::move(reading);
  looked_ns_ = now_ns;
}

std::int64_t SteadyReading::steady_ns(std::int64_t now_ns) const {
  return seen_ && !reading_.covered ? std::min(now_ns, looked_ns_ + longest_between_ns) - since_ns_ : -1;
}

}  // namespace counterpart
