// What somebody from outside needs to measure a performance: one JSON line a frame, places in B in metres, rounded to
// a hundredth of a millimetre.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "vhd_renderer/body/figure.hpp"
#include "vhd_renderer/motion/director.hpp"

namespace counterpart {

class Trace {
 public:
  // Both have to outlive it.
  Trace(const Figure& figure, const Director& director);

  // {"frame", "t": seconds, "joints": [{"name", "x", "y", "z"}], "pieces": the same, of the middles of their feet,
  //  "fingertips": {"l_thumb": [[x, y, z], ...], ...}: the drawn skin of the last bone of each
  //  finger that holds: thumb, forefinger, middle finger}
  nlohmann::json line(std::int64_t frame, std::int64_t now_ns, const Performance& performance);

 private:
  struct Fingertip {
    std::string name;
    std::vector<std::pair<std::size_t, std::size_t>> skin;  // part, vertex
  };

  const Figure& figure_;
  const Director& director_;
  std::vector<Fingertip> fingertips_;
  std::vector<SkinnedPart> skinned_;
};

}  // namespace counterpart
