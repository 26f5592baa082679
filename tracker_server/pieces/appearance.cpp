#include "tracker_server/pieces/appearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace counterpart {
namespace {

constexpr double corner_zone = 0.30;    // beyond this in both directions a round piece does not reach
constexpr double middle_radius = 0.25;  // squares
constexpr double whole_radius = 0.45;

// Octaves of evidence. Empty squares of real boards, wood grain and shadows included, scatter over about one; the
// weakest piece seen, black on black wood, stands at about one and a half.
constexpr double least_evidence = 0.9, usual_evidence = 1.3, most_evidence = 2.2;
constexpr double undecided = 0.12;

// Two pieces of one colour under one lamp are nearer than this.
constexpr float one_colour = 22;

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

float quantile(std::vector<float>& values, double share) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

Colour median_colour(const std::vector<Colour>& colours) {
  std::vector<float> light, red, warm;
  for (const Colour& c : colours) {
    light.push_back(c.light);
    red.push_back(c.red_green);
    warm.push_back(c.warm_cold);
  }
  return {median(light), median(red), median(warm)};
}

Colour mean_colour(const std::vector<Colour>& colours) {
  Colour sum;
  for (const Colour& c : colours) {
    sum.light += c.light;
    sum.red_green += c.red_green;
    sum.warm_cold += c.warm_cold;
  }
  const float scale = colours.empty() ? 0 : 1.0F / static_cast<float>(colours.size());
  return {sum.light * scale, sum.red_green * scale, sum.warm_cold * scale};
}

// Samples of a patch by zone, worked out once.
struct Zones {
  std::vector<std::size_t> corners, middle, whole;
  Zones() {
    for (int row = 0; row < patch_side; ++row)
      for (int col = 0; col < patch_side; ++col) {
        const double y = patch_place(row), x = patch_place(col), r = std::hypot(x, y);
        const auto i = static_cast<std::size_t>(row * patch_side + col);
        if (std::abs(x) > corner_zone && std::abs(y) > corner_zone) corners.push_back(i);
        if (r < middle_radius) middle.push_back(i);
        // One short of the last row and column: steepness looks one sample ahead.
        if (r < whole_radius && row + 1 < patch_side && col + 1 < patch_side) whole.push_back(i);
      }
  }
};

CellLook look_at(const CellPatch& patch, const Zones& zones) {
  CellLook look;
  look.seen = patch.seen;
  if (!patch.seen) return look;
  const auto& samples = patch.samples;
  std::vector<Colour> colours;
  for (std::size_t i : zones.corners) colours.push_back(samples[i]);
  look.ground = median_colour(colours);
  colours.clear();
  int burnt = 0;
  for (std::size_t i : zones.middle) {
    colours.push_back(samples[i]);
    burnt += samples[i].light > 250;
  }
  look.middle = median_colour(colours);
  look.glare = static_cast<float>(burnt) / static_cast<float>(zones.middle.size());

  std::vector<float> steep, different;
  for (std::size_t i : zones.whole) {
    const float across = length(samples[i + 1] - samples[i]), down = length(samples[i + patch_side] - samples[i]);
    steep.push_back(std::hypot(across, down));
    different.push_back(length(samples[i] - look.ground));
  }
  look.structure = quantile(steep, 0.75);
  look.difference = quantile(different, 0.75);
  return look;
}

// How much of a square differs from the empty ones of its colour: a hand covers the corners too, a piece does not.
void measure_cover(const BoardView& view, std::vector<CellLook>& cells) {
  for (int parity : {0, 1}) {
    std::vector<Colour> grounds;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const int row = static_cast<int>(i) / view.squares, col = static_cast<int>(i) % view.squares;
      if ((row + col) % 2 == parity && cells[i].seen) grounds.push_back(cells[i].ground);
    }
    if (grounds.size() < 4) continue;
    const Colour usual = median_colour(grounds);
    std::vector<float> spread;
    for (const Colour& ground : grounds) spread.push_back(length(ground - usual));
    const float tolerance = std::max(18.0F, 3 * median(spread));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const int row = static_cast<int>(i) / view.squares, col = static_cast<int>(i) % view.squares;
      if ((row + col) % 2 != parity || !cells[i].seen) continue;
      int other = 0;
      for (const Colour& sample : view.cells[i].samples) other += length(sample - usual) > tolerance;
      cells[i].full = static_cast<float>(other) / static_cast<float>(view.cells[i].samples.size());
    }
  }
}

// Octaves by which a square is busier and more different than the quietest of its colour.
std::vector<float> evidence_of(const std::vector<CellLook>& cells, int squares) {
  std::vector<float> evidence(cells.size(), 0);
  for (int parity : {0, 1}) {
    std::vector<float> structure, difference;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const int row = static_cast<int>(i) / squares, col = static_cast<int>(i) % squares;
      if ((row + col) % 2 != parity || !cells[i].seen) continue;
      structure.push_back(cells[i].structure);
      difference.push_back(cells[i].difference);
    }
    if (structure.empty()) continue;
    // At the start of a game a fifth of the playable squares is empty: the quietest sixth always is.
    const float quiet_structure = std::max(1.0F, quantile(structure, 0.16));
    const float quiet_difference = std::max(4.0F, quantile(difference, 0.16));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const int row = static_cast<int>(i) / squares, col = static_cast<int>(i) % squares;
      if ((row + col) % 2 != parity || !cells[i].seen) continue;
      const float s = std::log2(std::max(cells[i].structure, 0.5F * quiet_structure) / quiet_structure);
      const float d = std::log2(std::clamp(cells[i].difference / quiet_difference, 1.0F, 8.0F));
      evidence[i] = s + 0.4F * d;
    }
  }
  return evidence;
}

// The widest gap between the two groups, within what is sensible.
double threshold_of(std::vector<float> evidence) {
  std::sort(evidence.begin(), evidence.end());
  double best_gap = 0.25, threshold = usual_evidence;
  for (std::size_t i = 0; i + 1 < evidence.size(); ++i) {
    const double low = std::max<double>(evidence[i], least_evidence - 0.4);
    const double high = std::min<double>(evidence[i + 1], most_evidence + 0.4);
    const double middle = 0.5 * (low + high);
    if (middle < least_evidence || middle > most_evidence) continue;
    if (high - low > best_gap) {
      best_gap = high - low;
      threshold = middle;
    }
  }
  return threshold;
}

// Splits colours in two by the farthest pair and a few rounds of means.
void learn_piece_colours(const std::vector<Colour>& pieces, double board_middle, BoardLook& look) {
  if (pieces.empty()) return;
  const Colour all = mean_colour(pieces);
  const auto farther = [](const Colour& from) {
    return [from](const Colour& a, const Colour& b) { return length(a - from) < length(b - from); };
  };
  Colour a = *std::max_element(pieces.begin(), pieces.end(), farther(all));
  Colour b = *std::max_element(pieces.begin(), pieces.end(), farther(a));
  std::vector<Colour> near_a, near_b;
  for (int round = 0; round < 8; ++round) {
    near_a.clear();
    near_b.clear();
    for (const Colour& p : pieces) (length(p - a) <= length(p - b) ? near_a : near_b).push_back(p);
    if (near_a.empty() || near_b.empty()) break;
    a = mean_colour(near_a);
    b = mean_colour(near_b);
  }
  float scatter = 0;
  for (const Colour& p : near_a) scatter += length(p - a);
  for (const Colour& p : near_b) scatter += length(p - b);
  scatter /= static_cast<float>(pieces.size());
  look.two_colours = !near_a.empty() && !near_b.empty() && length(a - b) > std::max(one_colour, 2.2F * scatter);
  if (look.two_colours) {
    look.dark_piece = a.light <= b.light ? a : b;
    look.light_piece = a.light <= b.light ? b : a;
  } else if (all.light < board_middle) {
    look.dark_piece = all;
  } else {
    look.light_piece = all;
  }
}

}  // namespace

std::vector<CellLook> look_at_cells(const BoardView& view) {
  static const Zones zones;
  std::vector<CellLook> cells;
  cells.reserve(view.cells.size());
  for (const CellPatch& patch : view.cells) cells.push_back(look_at(patch, zones));
  measure_cover(view, cells);
  return cells;
}

Reading read_appearance(const std::vector<CellLook>& cells, int squares, std::optional<int> playable_parity) {
  Reading reading;
  reading.cells.resize(cells.size());
  reading.evidence = evidence_of(cells, squares);
  const auto parity_of = [&](std::size_t i) {
    return (static_cast<int>(i) / squares + static_cast<int>(i) % squares) % 2;
  };

  std::array<std::vector<float>, 2> by_parity;
  std::array<double, 2> busy{};
  std::array<std::vector<float>, 2> ground;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i].seen) continue;
    const auto parity = static_cast<std::size_t>(parity_of(i));
    by_parity[parity].push_back(reading.evidence[i]);
    busy[parity] += std::clamp<double>(reading.evidence[i] - usual_evidence, 0, 1);
    ground[parity].push_back(cells[i].ground.light);
  }
  BoardLook& look = reading.look;
  look.playable_parity = playable_parity.value_or(busy[0] > busy[1] ? 0 : 1);
  look.threshold = threshold_of(by_parity[static_cast<std::size_t>(look.playable_parity)]);
  double board_middle = 128;
  if (!ground[0].empty() && !ground[1].empty()) board_middle = 0.5 * (median(ground[0]) + median(ground[1]));

  std::vector<Colour> pieces;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i].seen && parity_of(i) == look.playable_parity && reading.evidence[i] > look.threshold + undecided)
      pieces.push_back(cells[i].middle);
  learn_piece_colours(pieces, board_middle, look);

  for (std::size_t i = 0; i < cells.size(); ++i) {
    CellSight& sight = reading.cells[i];
    if (!cells[i].seen) continue;
    if (parity_of(i) != look.playable_parity) {
      sight = {CellReading::empty, 1};
      continue;
    }
    const double above = reading.evidence[i] - look.threshold;
    sight.confidence = static_cast<float>(std::min(1.0, std::abs(above)));
    if (std::abs(above) < undecided || (above < 0 && cells[i].glare > 0.8F)) {
      sight.reading = CellReading::unknown;
    } else if (above < 0) {
      sight.reading = CellReading::empty;
    } else if (look.two_colours) {
      const bool dark = length(cells[i].middle - look.dark_piece) <= length(cells[i].middle - look.light_piece);
      sight.reading = dark ? CellReading::dark : CellReading::light;
    } else {
      sight.reading = cells[i].middle.light < board_middle ? CellReading::dark : CellReading::light;
    }
  }
  return reading;
}

}  // namespace counterpart
