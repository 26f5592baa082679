// The sound of a film: AAC, one channel, silent where nobody speaks.
#pragma once

#include <memory>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/output/ffmpeg_handles.hpp"
#include "vhd_renderer/voice/sound.hpp"

namespace counterpart {

class SoundTrack {
 public:
  // Before the film's header is written. Fails where FFmpeg has no AAC.
  static Result<SoundTrack> add_to(AVFormatContext& film, int rate_hz);

  // Continues the track up to `until_s` of the film with what is heard: `sound` (null: silence) from its `from_s` on.
  // Returns FFmpeg's code, 0 or below.
  int write(const Sound* sound, double from_s, double until_s);
  int finish();

 private:
  SoundTrack() = default;

  int write_sample(float sample);

  AVFormatContext* film_ = nullptr;
  AVStream* stream_ = nullptr;  // owned by the film
  std::unique_ptr<AVCodecContext, CodecDeleter> codec_;
  std::unique_ptr<AVFrame, FrameDeleter> frame_;
  std::unique_ptr<AVPacket, PacketDeleter> packet_;
  int filled_ = 0;            // of the frame
  std::int64_t written_ = 0;  // samples
};

}  // namespace counterpart
