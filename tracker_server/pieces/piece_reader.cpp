#include "tracker_server/pieces/piece_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "protocol/vocabulary/board_geometry.hpp"

namespace counterpart {
namespace {

// A reading counts once it was the same so many frames in a row.
constexpr int frames_to_believe = 3;

// After a longer time without a picture of the board, anything may have happened to it.
constexpr std::int64_t longest_between_ns = 250'000'000;

// Whether all the real pieces that are expected belong to one side.
bool one_side(const std::string& expected) {
  const bool dark = expected.find_first_of("bB") != std::string::npos;
  const bool light = expected.find_first_of("wW") != std::string::npos;
  return dark != light;
}

}  // namespace

PieceReader::PieceReader(int squares, ReadingMethod method) : squares_(squares), method_(method) {
  forget();
}

void PieceReader::forget() {
  calibration_ = {};
  tolerance_ = {};
  scan_rule_.reset();
  memory_.assign(static_cast<std::size_t>(squares_ * squares_), {});
  started_ = false;
}

Reading PieceReader::read_now(const std::vector<CellLook>& looks, const std::vector<double>& scan) {
  if (method_ == ReadingMethod::appearance) {
    if (calibration_.too_dark(board_light(looks, squares_)))
      return Reading{std::vector<CellSight>(looks.size()), {}, {}};
    return read_appearance(looks, squares_, {1, one_side(expected_), &calibration_});
  }
  // The light changes: the rule is learned anew from every picture in which the expected position allows it.
  if (const auto rule = scan_rule(scan, squares_, expected_); rule && (rule->from_known || !scan_rule_)) {
    scan_rule_ = rule;
  }
  Reading reading;
  reading.cells.resize(looks.size());
  if (scan_rule_) reading.cells = read_scan(scan, squares_, scan_rule_->threshold, scan_rule_->pieces_dark);
  return reading;
}

PieceReading PieceReader::read(const BoardView& view, const FrameStamp& stamp, const std::vector<double>& scan) {
  const std::vector<CellLook> looks = look_at_cells(view, 1, tolerance_);
  const Reading now = read_now(looks, scan);
  PieceReading result;
  std::vector<bool> was_empty;
  for (const CellMemory& memory : memory_) was_empty.push_back(memory.steady == CellReading::empty);
  result.cover = find_cover(view, looks, was_empty, tolerance_);
  Occupancy& occupancy = result.occupancy;
  occupancy.stamp = stamp;
  occupancy.squares = squares_;
  occupancy.cells.resize(memory_.size());

  bool changed = !started_ || stamp.capture_ns - read_ns_ > longest_between_ns;
  read_ns_ = stamp.capture_ns;
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    CellMemory& memory = memory_[i];
    // A reflection, or a hand that hides nothing but this square: what looks empty need not be.
    const bool veiled = now.cells[i].reading == CellReading::empty && looks[i].full > covered_share;
    if (result.cover.cells[i] || veiled) {
      memory.times = 0;
      occupancy.cells[i] = {CellReading::unknown, 0};
      continue;
    }
    const CellSight& sight = now.cells[i];
    memory.times = sight.reading == memory.last ? memory.times + 1 : 1;
    memory.last = sight.reading;
    memory.confidence += 0.3F * (sight.confidence - memory.confidence);
    if (memory.times >= frames_to_believe && memory.steady != memory.last) {
      memory.steady = memory.last;
      changed = true;
    }
    occupancy.cells[i] = {memory.steady, memory.confidence};
  }
  occupancy.covered = result.cover.any;
  if (!occupancy.covered && method_ == ReadingMethod::appearance) learn(view, looks);
  if (changed || occupancy.covered || stamp.capture_ns < changed_ns_) changed_ns_ = stamp.capture_ns;
  started_ = true;
  occupancy.stable_ns = stamp.capture_ns - changed_ns_;
  return result;
}

// The start position is the calibration, and every position after it.
void PieceReader::learn(const BoardView& view, const std::vector<CellLook>& looks) {
  const int last = playable_squares(squares_);
  if (static_cast<int>(expected_.size()) != last) return;
  const BoardLight light = board_light(looks, squares_);
  if (calibration_.too_dark(light)) return;
  const ExtraNoise extra = calibration_.extra_noise(light);
  std::vector<KnownSquare> known;
  for (int square = 1; square <= last; ++square) {
    const Cell cell = cell_of_square(square, squares_);
    const CellLook& look = looks[static_cast<std::size_t>(cell.row * squares_ + cell.col)];
    if (look.seen)
      known.push_back({features_of(look, light.step, extra), expected_[static_cast<std::size_t>(square - 1)] != 'e'});
  }
  // Of a board that is half out of the picture nothing is usual.
  constexpr double enough = 0.6;
  if (static_cast<double>(known.size()) < enough * last) return;
  if (calibration_.learn(known, light)) learn_tolerance(view, looks, light);
}

void PieceReader::learn_tolerance(const BoardView& view, const std::vector<CellLook>& looks, const BoardLight& light) {
  constexpr double rate = 0.04;   // of a picture
  constexpr double leeway = 1.5;  // light may become a little more uneven than it was
  const std::array<GroundLook, 2> grounds = ground_looks(view, looks, tolerance_);
  for (const std::size_t parity : {0U, 1U}) {
    double& most = tolerance_.steps[parity];
    const double now = leeway * grounds[parity].tolerance / light.step;
    if (grounds[parity].known) most = std::isinf(most) ? now : most + rate * (now - most);
  }
}

bool PieceReader::looks_turned_round() const {
  const int last = playable_squares(squares_);
  if (static_cast<int>(expected_.size()) != last) return false;
  int wrong = 0, wrong_if_turned = 0;
  for (int square = 1; square <= last; ++square) {
    const Cell cell = cell_of_square(square, squares_);
    const CellReading seen = memory_[static_cast<std::size_t>(cell.row * squares_ + cell.col)].steady;
    if (seen == CellReading::unknown) continue;
    const auto fits = [&](int expected_square) {
      const char want = expected_[static_cast<std::size_t>(expected_square - 1)];
      return (want != 'e') == (seen != CellReading::empty);
    };
    wrong += !fits(square);
    wrong_if_turned += !fits(last + 1 - square);
  }
  // Clear enough that neither a hand over some pieces nor a long capture can do it.
  constexpr int clearly = 6;
  return wrong_if_turned < 0.1 * last && wrong >= clearly + 3 * wrong_if_turned;
}

}  // namespace counterpart
