// Edges looked for along normals, directly on the grey picture: no gradient image is made.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace counterpart {

// What became of an edge point. Numbers go out in the debug view and are never renumbered.
enum class EdgeVerdict : std::uint8_t {
  accepted = 1,
  outside = 2,         // its search line leaves the picture
  low_contrast = 3,    // no edge strong enough
  ambiguous = 4,       // two edges about equally good
  outlier = 5,         // an edge, but not where all the others say
  wrong_contrast = 6,  // an edge of quite another strength or brightness than this one has: something lies over it
  not_searched = 7,
  lonely = 8,  // an edge, but most points of its segment found none: something lies over them
};

// Where to look: a point in pixels and a unit normal.
struct EdgeProbe {
  float x = 0, y = 0;
  float nx = 0, ny = 0;
  std::int8_t polarity = 0;  // +1: brighter towards +n; -1: darker towards +n; 0: either
  float contrast = 0;        // grey levels of the step that is expected; 0: not known, the strongest is taken
};

struct EdgeHit {
  float distance = 0;  // pixels along the normal to the edge
  float contrast = 0;  // grey levels of the step, > 0 if brighter towards +n
  float grey = 0;      // grey level half way up the step
  EdgeVerdict verdict = EdgeVerdict::not_searched;
};

struct EdgeSearch {
  float reach = 6;          // pixels looked at to both sides
  float min_contrast = 12;  // grey levels
};

// Writes one hit a probe. hits.size() must equal probes.size().
void search_edges(const cv::Mat1b& grey, std::span<const EdgeProbe> probes, const EdgeSearch& search,
                  std::span<EdgeHit> hits);

}  // namespace counterpart
