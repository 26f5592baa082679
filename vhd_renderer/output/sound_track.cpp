#include "vhd_renderer/output/sound_track.hpp"

#include <cmath>

namespace counterpart {

Result<SoundTrack> SoundTrack::add_to(AVFormatContext& film, int rate_hz) {
  const AVCodec* encoder = avcodec_find_encoder(AV_CODEC_ID_AAC);
  if (encoder == nullptr) return failure(ErrorCode::unsupported, "this FFmpeg has no AAC encoder; the film stays mute");
  SoundTrack track;
  track.film_ = &film;
  track.codec_.reset(avcodec_alloc_context3(encoder));
  track.codec_->sample_rate = rate_hz;
  track.codec_->sample_fmt = AV_SAMPLE_FMT_FLTP;
  track.codec_->bit_rate = 64'000;
  track.codec_->time_base = {1, rate_hz};
  av_channel_layout_default(&track.codec_->ch_layout, 1);
  if ((film.oformat->flags & AVFMT_GLOBALHEADER) != 0) track.codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (avcodec_open2(track.codec_.get(), encoder, nullptr) < 0) {
    return failure(ErrorCode::unsupported, "the AAC encoder does not take speech; the film stays mute");
  }
  track.stream_ = avformat_new_stream(&film, nullptr);
  track.stream_->time_base = track.codec_->time_base;
  avcodec_parameters_from_context(track.stream_->codecpar, track.codec_.get());
  track.frame_.reset(av_frame_alloc());
  track.frame_->format = track.codec_->sample_fmt;
  track.frame_->sample_rate = rate_hz;
  track.frame_->nb_samples = track.codec_->frame_size;
  av_channel_layout_copy(&track.frame_->ch_layout, &track.codec_->ch_layout);
  if (av_frame_get_buffer(track.frame_.get(), 0) < 0) return failure(ErrorCode::internal, "out of memory for sound");
  track.packet_.reset(av_packet_alloc());
  return track;
}

int SoundTrack::write(const Sound* sound, double from_s, double until_s) {
  const int rate = codec_->sample_rate;
  const auto until = static_cast<std::int64_t>(std::llround(until_s * rate));
  const double step = sound == nullptr ? 0 : static_cast<double>(sound->rate_hz) / rate;
  const double first = sound == nullptr ? 0 : std::round(from_s * sound->rate_hz);
  for (std::int64_t i = 0; written_ < until; ++i) {
    float sample = 0;
    const auto at = static_cast<std::int64_t>(first + static_cast<double>(i) * step);
    if (sound != nullptr && at >= 0 && at < static_cast<std::int64_t>(sound->samples.size())) {
      sample = static_cast<float>(sound->samples[static_cast<std::size_t>(at)]) / 32768.F;
    }
    if (const int code = write_sample(sample); code < 0) return code;
  }
  return 0;
}

int SoundTrack::write_sample(float sample) {
  if (filled_ == 0 && av_frame_make_writable(frame_.get()) < 0) return AVERROR(ENOMEM);
  reinterpret_cast<float*>(frame_->data[0])[filled_++] = sample;
  ++written_;
  if (filled_ < frame_->nb_samples) return 0;
  frame_->pts = written_ - filled_;
  filled_ = 0;
  return encode_into(*film_, *codec_, *stream_, *packet_, frame_.get());
}

int SoundTrack::finish() {
  while (filled_ != 0) {
    if (const int code = write_sample(0); code < 0) return code;
  }
  return encode_into(*film_, *codec_, *stream_, *packet_, nullptr);
}

}  // namespace counterpart
