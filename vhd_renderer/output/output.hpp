// Where the mirror's pictures go: a film, a folder of pictures.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/voice/sound.hpp"

namespace counterpart {

class Output {
 public:
  virtual ~Output() = default;

  // bgr: CV_8UC3, of the same size every time. stamp_ns grows from picture to picture; it sets the time in the film.
  [[nodiscard]] virtual Result<void> write(const cv::Mat& bgr, std::int64_t stamp_ns) = 0;

  // What is heard from the next picture on: `sound` (null: nothing) from its `from_s`. For outputs that have sound.
  virtual void hear(std::shared_ptr<const Sound> sound, double from_s);

  // Completes the file. What was written before is readable even if this is never reached.
  [[nodiscard]] virtual Result<void> finish() = 0;
};

// target: FILE.mp4 (H.264), or a folder, made if it is not there, for frame_%05d.png.
// sound_rate_hz: of a film's sound; 0: a mute film.
[[nodiscard]] Result<std::unique_ptr<Output>> open_output(const std::string& target, int sound_rate_hz = 0);

}  // namespace counterpart
