// The mirror as a film: H.264 in a fragmented MP4, so that what was recorded stays readable if the program is killed.
#pragma once

#include <memory>
#include <string>

#include "vhd_renderer/output/output.hpp"

namespace counterpart {

// The file is opened with the first picture, whose size becomes the film's; odd sizes lose their last row or column.
// sound_rate_hz 0: a film without sound.
[[nodiscard]] Result<std::unique_ptr<Output>> open_film(const std::string& file, int sound_rate_hz);

}  // namespace counterpart
