#include "tracker_server/pieces/appearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tracker_server/pieces/calibration.hpp"

namespace counterpart {
namespace {

constexpr double corner_zone = 0.30;    // beyond this in both directions a round piece does not reach
constexpr double middle_radius = 0.25;  // squares
constexpr double whole_radius = 0.45;

// Octaves of evidence. Empty squares of real boards, wood grain and shadows included, scatter over about one; the
// weakest piece seen, black on black wood, stands at about one and a half.
constexpr double least_evidence = 0.9, usual_evidence = 1.3, most_evidence = 2.2;
constexpr double clear_evidence = 2.7;
constexpr double undecided = 0.12;
constexpr double undecided_score = 0.2;

// A fifth of the squares that are never played on, all over the board, is looked at as a whole: how busy is a square on
// which nothing stands?
bool shows_floor(std::size_t cell, int squares) {
  const auto n = static_cast<std::size_t>(squares);
  const std::size_t row = cell / n;
  return (row + cell % n) % 2 == 0 && (cell / 2 + 2 * row) % 5 == 0;
}

// An empty square is never taken for quieter than these shares of the step between light and dark squares: on a clean,
// bright board a smear would stand out as much as a piece.
constexpr float quietest_structure = 1.0F / 60, quietest_difference = 1.0F / 20;

// Pieces of one colour are nearer than this, in the measure of `unlike`.
constexpr float one_colour = 22;

// A lamp's reflection lights up a whole square; a piece in it still differs from the ground by this share of that.
constexpr float outshines_glare = 0.5F, glare_share = 0.5F;
constexpr float glare_from = 25;  // grey levels above the usual ground

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

float square_length(const Colour& c) {
  return c.light * c.light + c.red_green * c.red_green + c.warm_cold * c.warm_cold;
}

// How unlike two pieces are: light and shade change a piece's brightness more than its hue.
float unlike(const Colour& a, const Colour& b) {
  Colour difference = a - b;
  difference.light *= 0.6F;
  return length(difference);
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
        // Neighbours have pixels in common: every other one is enough for a median.
        const bool every_other = (row + col) % 2 == 0;
        if (every_other && std::abs(x) > corner_zone && std::abs(y) > corner_zone) corners.push_back(i);
        if (every_other && r < middle_radius) middle.push_back(i);
        // One short of the last row and column: steepness looks one sample ahead.
        if (r < whole_radius && row + 1 < patch_side && col + 1 < patch_side) whole.push_back(i);
      }
  }
};

// Of so few values the one with half of them below it is found faster by counting than by sorting: no branch depends on
// what they are.
constexpr std::size_t most_in_zone = 24;
using FewValues = std::array<float, most_in_zone>;  // what is not used is infinite

float median_of_few(const FewValues& values, std::size_t count) {
  const auto middle = static_cast<int>(count / 2);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    int below = 0, alike = 0;
    for (std::size_t k = 0; k < most_in_zone; ++k) {
      below += values[k] < values[i];
      alike += values[k] == values[i];
    }
    if (below <= middle && middle < below + alike) return values[i];
  }
  return values[count - 1];
}

// The median of each channel over a few samples.
Colour median_colour(const std::vector<Colour>& samples, const std::vector<std::size_t>& zone) {
  std::array<FewValues, 3> channels;
  for (FewValues& channel : channels) channel.fill(std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < zone.size(); ++i) {
    const Colour& c = samples[zone[i]];
    channels[0][i] = c.light;
    channels[1][i] = c.red_green;
    channels[2][i] = c.warm_cold;
  }
  return {median_of_few(channels[0], zone.size()), median_of_few(channels[1], zone.size()),
          median_of_few(channels[2], zone.size())};
}

CellLook look_at(const CellPatch& patch, const Zones& zones, bool ground_only) {
  CellLook look;
  look.seen = patch.seen;
  if (!patch.seen) return look;
  const auto& samples = patch.samples;
  look.ground = median_colour(samples, zones.corners);
  if (ground_only) return look;
  look.middle = median_colour(samples, zones.middle);
  const auto burnt =
      std::count_if(zones.middle.begin(), zones.middle.end(), [&](std::size_t i) { return samples[i].light > 250; });
  look.glare = static_cast<float>(burnt) / static_cast<float>(zones.middle.size());

  // Squares keep the order, so that one root a quantile is enough.
  std::array<float, patch_side * patch_side> steep, different;
  std::size_t count = 0;
  for (std::size_t i : zones.whole) {
    steep[count] = square_length(samples[i + 1] - samples[i]) + square_length(samples[i + patch_side] - samples[i]);
    different[count++] = square_length(samples[i] - look.ground);
  }
  const auto quartile = [&](auto& values) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(0.75 * static_cast<double>(count - 1));
    std::nth_element(values.begin(), place, values.begin() + static_cast<std::ptrdiff_t>(count));
    return *place;
  };
  look.structure = std::sqrt(quartile(steep));
  look.difference = std::sqrt(quartile(different));
  return look;
}

std::size_t parity_of(std::size_t cell, int squares) {
  const auto n = static_cast<std::size_t>(squares);
  return (cell / n + cell % n) % 2;
}

// How far the samples of this parity's squares usually are from their usual colour: shading, grain, noise.
float usual_scatter(const BoardView& view, std::size_t parity, const Colour& usual) {
  constexpr std::size_t every = 13;  // enough of them, and all over the square
  std::vector<float> scatter;
  for (std::size_t i = 0; i < view.cells.size(); ++i) {
    if (parity_of(i, view.squares) != parity || !view.cells[i].seen) continue;
    const auto& samples = view.cells[i].samples;
    for (std::size_t k = 0; k < samples.size(); k += every) scatter.push_back(length(samples[k] - usual));
  }
  return median(scatter);
}

// How much of a square differs from the empty ones of its colour: a hand covers the corners too, a piece does not.
void measure_cover(const BoardView& view, const GroundTolerance& most, std::vector<CellLook>& cells) {
  const std::array<GroundLook, 2> grounds = ground_looks(view, cells, most);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const GroundLook& ground = grounds[parity_of(i, view.squares)];
    if (!ground.known || !cells[i].seen) continue;
    const float limit = ground.tolerance * ground.tolerance;
    int other = 0;
    for (const Colour& sample : view.cells[i].samples) other += square_length(sample - ground.usual) > limit;
    cells[i].full = static_cast<float>(other) / static_cast<float>(view.cells[i].samples.size());
  }
}

std::array<Colour, 2> usual_grounds(const std::vector<CellLook>& cells, int squares) {
  std::array<std::vector<Colour>, 2> grounds;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i].seen) grounds[parity_of(i, squares)].push_back(cells[i].ground);
  std::array<Colour, 2> usual;
  for (std::size_t parity : {0U, 1U})
    if (!grounds[parity].empty()) usual[parity] = median_colour(grounds[parity]);
  return usual;
}

bool only_glare(const CellLook& cell, const Colour& usual_ground) {
  if (cell.full < glare_share || cell.ground.light - usual_ground.light < glare_from) return false;
  return length(cell.middle - cell.ground) < outshines_glare * length(cell.ground - usual_ground);
}

// Octaves by which a square is busier and more different than the quietest of its colour.
std::vector<float> evidence_of(const std::vector<CellLook>& cells, int squares, const std::array<Colour, 2>& usual) {
  std::vector<float> evidence(cells.size(), 0);
  const float step = length(usual[0] - usual[1]);
  for (std::size_t parity : {0U, 1U}) {
    std::vector<float> structure, difference;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (parity_of(i, squares) != parity || !cells[i].seen) continue;
      structure.push_back(cells[i].structure);
      difference.push_back(cells[i].difference);
    }
    if (structure.empty()) continue;
    // At the start of a game a fifth of the playable squares is empty: the quietest sixth always is.
    const float quiet_structure = std::max({1.0F, quietest_structure * step, quantile(structure, 0.16)});
    const float quiet_difference = std::max({4.0F, quietest_difference * step, quantile(difference, 0.16)});
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (parity_of(i, squares) != parity || !cells[i].seen || only_glare(cells[i], usual[parity])) continue;
      const float s = std::log2(std::max(cells[i].structure, 0.5F * quiet_structure) / quiet_structure);
      const float d = std::log2(std::clamp(cells[i].difference / quiet_difference, 1.0F, 8.0F));
      evidence[i] = s + 0.4F * d;
    }
  }
  return evidence;
}

std::vector<float> scores_of(const std::vector<CellLook>& cells, int squares, const std::array<Colour, 2>& usual,
                             const SquareCalibration& calibration) {
  std::vector<float> scores(cells.size(), -1);
  const BoardLight light = board_light(cells, squares);
  const ExtraNoise extra = calibration.extra_noise(light);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i].seen || only_glare(cells[i], usual[parity_of(i, squares)])) continue;
    scores[i] = static_cast<float>(calibration.score(features_of(cells[i], light.step, extra)));
  }
  return scores;
}

// The widest gap between the two groups, within what is sensible. Without a gap, all is one group: if none of it looks
// clearly like a piece, it is the empty squares.
double threshold_of(std::vector<float> evidence) {
  std::sort(evidence.begin(), evidence.end());
  double best_gap = 0.25;
  double threshold = evidence.empty() || evidence.back() > most_evidence ? usual_evidence : most_evidence;
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
  // One or two squares that are hardly out of the ordinary are folds, stains or reflections rather than a game.
  const auto above = std::count_if(evidence.begin(), evidence.end(), [&](float e) { return e > threshold; });
  if (above <= 2 && !evidence.empty() && evidence.back() < clear_evidence) threshold = clear_evidence;
  return threshold;
}

struct ColourSplit {
  Colour a, b;
  float scatter = 0;  // mean distance of a piece from its group's mean
  bool two = false;
};

// In two groups, begun from this piece and the one most unlike it, and evened out by a few rounds of means.
ColourSplit split_from(const std::vector<Colour>& pieces, const Colour& seed) {
  ColourSplit split;
  split.a = seed;
  split.b = *std::max_element(pieces.begin(), pieces.end(),
                              [&](const Colour& p, const Colour& q) { return unlike(p, seed) < unlike(q, seed); });
  std::vector<Colour> near_a, near_b;
  for (int round = 0; round < 5; ++round) {
    near_a.clear();
    near_b.clear();
    for (const Colour& p : pieces) (unlike(p, split.a) <= unlike(p, split.b) ? near_a : near_b).push_back(p);
    if (near_a.empty() || near_b.empty()) break;
    split.a = mean_colour(near_a);
    split.b = mean_colour(near_b);
  }
  split.two = !near_a.empty() && !near_b.empty();
  for (const Colour& p : near_a) split.scatter += unlike(p, split.a);
  for (const Colour& p : near_b) split.scatter += unlike(p, split.b);
  split.scatter /= static_cast<float>(pieces.size());
  return split;
}

void learn_piece_colours(const std::vector<Colour>& pieces, double board_middle, bool one_side, BoardLook& look) {
  if (pieces.empty()) return;
  // From one seed the groups may end up as "the two in the light" and "all others": the tightest of many is taken.
  ColourSplit best = split_from(pieces, pieces.front());
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const ColourSplit split = split_from(pieces, pieces[i]);
    if (split.two && (!best.two || split.scatter < best.scatter)) best = split;
  }
  look.two_colours = !one_side && best.two && unlike(best.a, best.b) > std::max(one_colour, 2.2F * best.scatter);
  const Colour all = mean_colour(pieces);
  if (look.two_colours) {
    look.dark_piece = best.a.light <= best.b.light ? best.a : best.b;
    look.light_piece = best.a.light <= best.b.light ? best.b : best.a;
  } else if (all.light < board_middle) {
    look.dark_piece = all;
  } else {
    look.light_piece = all;
  }
}

}  // namespace

std::array<GroundLook, 2> ground_looks(const BoardView& view, const std::vector<CellLook>& cells,
                                       const GroundTolerance& most) {
  constexpr double least = 18, of_usual = 2.5;  // grey levels; times the usual scatter
  const std::array<Colour, 2> usual = usual_grounds(cells, view.squares);
  const double step = length(usual[0] - usual[1]);
  std::array<GroundLook, 2> looks;
  for (const std::size_t parity : {0U, 1U}) {
    std::size_t seen = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) seen += parity_of(i, view.squares) == parity && cells[i].seen;
    if (seen < 4) continue;
    const double scatter = usual_scatter(view, parity, usual[parity]);
    const double tolerance = std::max(least, std::min(of_usual * scatter, most.steps[parity] * step));
    looks[parity] = {usual[parity], static_cast<float>(tolerance), true};
  }
  return looks;
}

std::vector<CellLook> look_at_cells(const BoardView& view, std::optional<int> played, const GroundTolerance& most) {
  static const Zones zones;
  std::vector<CellLook> cells;
  cells.reserve(view.cells.size());
  for (std::size_t i = 0; i < view.cells.size(); ++i) {
    const bool unplayed = played && parity_of(i, view.squares) != static_cast<std::size_t>(*played);
    const bool ground_only = unplayed && !shows_floor(i, view.squares);
    cells.push_back(look_at(view.cells[i], zones, ground_only));
  }
  measure_cover(view, most, cells);
  return cells;
}

BoardLight board_light(const std::vector<CellLook>& cells, int squares) {
  const std::array<Colour, 2> usual = usual_grounds(cells, squares);
  std::vector<float> structures;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (shows_floor(i, squares) && cells[i].seen) structures.push_back(cells[i].structure);
  constexpr float least = 1;  // no camera is quite without noise
  return {length(usual[0] - usual[1]), structures.empty() ? 0 : std::max(least, median(structures))};
}

Reading read_appearance(const std::vector<CellLook>& cells, int squares, const Foreknowledge& known) {
  Reading reading;
  reading.cells.resize(cells.size());
  const std::array<Colour, 2> usual = usual_grounds(cells, squares);
  const bool calibrated = known.calibration != nullptr && known.calibration->ready();
  reading.evidence =
      calibrated ? scores_of(cells, squares, usual, *known.calibration) : evidence_of(cells, squares, usual);

  std::array<std::vector<float>, 2> by_parity;
  std::array<double, 2> busy{};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i].seen) continue;
    const std::size_t parity = parity_of(i, squares);
    by_parity[parity].push_back(reading.evidence[i]);
    busy[parity] += std::clamp<double>(reading.evidence[i] - usual_evidence, 0, 1);
  }
  BoardLook& look = reading.look;
  look.playable_parity = known.playable_parity.value_or(busy[0] > busy[1] ? 0 : 1);
  const auto played = static_cast<std::size_t>(look.playable_parity);
  look.threshold = calibrated ? 0 : threshold_of(by_parity[played]);
  const double doubt = calibrated ? undecided_score : undecided;
  const double board_middle = 0.5 * (usual[0].light + usual[1].light);

  std::vector<Colour> pieces;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i].seen && parity_of(i, squares) == played && reading.evidence[i] > look.threshold + doubt)
      pieces.push_back(cells[i].middle);
  learn_piece_colours(pieces, board_middle, known.one_colour, look);

  for (std::size_t i = 0; i < cells.size(); ++i) {
    CellSight& sight = reading.cells[i];
    if (!cells[i].seen) continue;
    if (parity_of(i, squares) != played) {
      sight = {CellReading::empty, 1};
      continue;
    }
    const double above = reading.evidence[i] - look.threshold;
    sight.confidence = static_cast<float>(std::min(1.0, std::abs(above)));
    if (std::abs(above) < doubt || (above < 0 && cells[i].glare > 0.8F)) {
      sight.reading = CellReading::unknown;
    } else if (above < 0) {
      sight.reading = CellReading::empty;
    } else if (look.two_colours) {
      const bool dark = unlike(cells[i].middle, look.dark_piece) <= unlike(cells[i].middle, look.light_piece);
      sight.reading = dark ? CellReading::dark : CellReading::light;
    } else {
      sight.reading = cells[i].middle.light < board_middle ? CellReading::dark : CellReading::light;
    }
  }
  return reading;
}

}  // namespace counterpart
