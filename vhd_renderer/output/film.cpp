#include "vhd_renderer/output/film.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

extern "C" {
#include <libavutil/opt.h>
}

#include "vhd_renderer/output/ffmpeg_handles.hpp"
#include "vhd_renderer/output/sound_track.hpp"

namespace counterpart {
namespace {

constexpr int kTicksPerSecond = 90'000;

std::string sentence(const char* what, const std::string& file, int code) {
  return std::string("cannot ") + what + " film '" + file + "': " + ffmpeg_reason(code);
}

class Film final : public Output {
 public:
  Film(std::string file, int sound_rate_hz) : file_(std::move(file)), sound_rate_hz_(sound_rate_hz) {}
  ~Film() override { static_cast<void>(finish()); }
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  Result<void> write(const cv::Mat& bgr, std::int64_t stamp_ns) override {
    if (!format_) {
      if (auto opened = open(bgr.cols & ~1, bgr.rows & ~1); !opened) return opened;
      first_ns_ = stamp_ns;
    }
    if (bgr.cols < codec_->width || bgr.rows < codec_->height) {
      return failure(ErrorCode::invalid_argument, "film '" + file_ + "': the size of the pictures changed on the way");
    }
    if (av_frame_make_writable(frame_.get()) < 0) return failure(ErrorCode::internal, "out of memory for a film frame");
    const std::uint8_t* source[] = {bgr.data};
    const int source_stride[] = {static_cast<int>(bgr.step[0])};
    sws_scale(scaler_.get(), source, source_stride, 0, codec_->height, frame_->data, frame_->linesize);
    const std::int64_t ticks = (stamp_ns - first_ns_) / (1'000'000'000 / kTicksPerSecond);
    frame_->pts = ticks > last_ticks_ ? ticks : last_ticks_ + 1;  // a film's time only goes forwards
    last_ticks_ = frame_->pts;
    const double now_s = 1e-9 * static_cast<double>(stamp_ns - first_ns_);
    if (track_) {
      if (const int code = track_->write(heard_.get(), heard_from_s_, now_s); code < 0) return trouble("encode", code);
    }
    heard_ = std::move(coming_);
    heard_from_s_ = coming_from_s_;
    return encode(frame_.get());
  }

  void hear(std::shared_ptr<const Sound> sound, double from_s) override {
    coming_ = std::move(sound);
    coming_from_s_ = from_s;
  }

  Result<void> finish() override {
    if (!format_) return {};
    auto flushed = encode(nullptr);
    if (track_ && flushed) {
      if (const int code = track_->finish(); code < 0) flushed = trouble("encode", code);
    }
    const int code = av_write_trailer(format_.get());
    track_.reset();
    format_.reset();
    if (!flushed) return flushed;
    if (code < 0) return failure(ErrorCode::io, sentence("finish", file_, code));
    return {};
  }

 private:
  Result<void> open(int width, int height) {
    const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
    if (encoder == nullptr) encoder = avcodec_find_encoder(AV_CODEC_ID_H264);
    if (encoder == nullptr)
      return failure(ErrorCode::unsupported, "this FFmpeg has no H.264 encoder; write a folder of pictures instead");
    AVFormatContext* format = nullptr;
    if (const int code = avformat_alloc_output_context2(&format, nullptr, "mp4", file_.c_str()); code < 0) {
      return failure(ErrorCode::io, sentence("open", file_, code));
    }
    format_.reset(format);
    codec_.reset(avcodec_alloc_context3(encoder));
    codec_->width = width;
    codec_->height = height;
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->time_base = {1, kTicksPerSecond};
    codec_->gop_size = 50;
    codec_->thread_count = 1;  // the same bytes each time, and the other core is the tracker's
    av_opt_set(codec_->priv_data, "preset", "veryfast", 0);
    av_opt_set(codec_->priv_data, "crf", "22", 0);
    av_opt_set(codec_->priv_data, "rc-lookahead", "10", 0);  // bounds what a kill can lose
    if ((format->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (const int code = avcodec_open2(codec_.get(), encoder, nullptr); code < 0) return give_up("encode", code);
    stream_ = avformat_new_stream(format, nullptr);
    stream_->time_base = codec_->time_base;
    avcodec_parameters_from_context(stream_->codecpar, codec_.get());
    if (sound_rate_hz_ > 0) {
      auto track = SoundTrack::add_to(*format, sound_rate_hz_);
      if (!track) {
        format_.reset();
        return tl::make_unexpected(track.error());
      }
      track_.emplace(std::move(*track));
    }
    if (const int code = avio_open(&format->pb, file_.c_str(), AVIO_FLAG_WRITE); code < 0) return give_up("open", code);
    format->flags |= AVFMT_FLAG_FLUSH_PACKETS;  // on disk as soon as a fragment is whole
    AVDictionary* options = nullptr;
    av_dict_set(&options, "movflags", "frag_keyframe+empty_moov+default_base_moof", 0);
    const int code = avformat_write_header(format, &options);
    av_dict_free(&options);
    if (code < 0) return give_up("start", code);
    frame_.reset(av_frame_alloc());
    frame_->format = codec_->pix_fmt;
    frame_->width = width;
    frame_->height = height;
    if (const int got = av_frame_get_buffer(frame_.get(), 0); got < 0) return give_up("encode", got);
    packet_.reset(av_packet_alloc());
    scaler_.reset(sws_getContext(width, height, AV_PIX_FMT_BGR24, width, height, codec_->pix_fmt, SWS_POINT, nullptr,
                                 nullptr, nullptr));
    return {};
  }

  Result<void> trouble(const char* what, int code) const { return failure(ErrorCode::io, sentence(what, file_, code)); }

  Result<void> give_up(const char* what, int code) {
    track_.reset();
    format_.reset();
    return trouble(what, code);
  }

  // null: flushes what the encoder still holds.
  Result<void> encode(const AVFrame* frame) {
    const int code = encode_into(*format_, *codec_, *stream_, *packet_, frame);
    return code < 0 ? trouble("encode", code) : Result<void>{};
  }

  std::string file_;
  std::unique_ptr<AVFormatContext, FormatDeleter> format_;
  std::unique_ptr<AVCodecContext, CodecDeleter> codec_;
  std::unique_ptr<AVFrame, FrameDeleter> frame_;
  std::unique_ptr<AVPacket, PacketDeleter> packet_;
  std::unique_ptr<SwsContext, ScalerDeleter> scaler_;
  AVStream* stream_ = nullptr;  // owned by format_
  int sound_rate_hz_ = 0;       // 0: mute
  std::optional<SoundTrack> track_;
  std::shared_ptr<const Sound> heard_;  // since the last picture, from heard_from_s_ on
  std::shared_ptr<const Sound> coming_;
  double heard_from_s_ = 0;
  double coming_from_s_ = 0;
  std::int64_t first_ns_ = 0;
  std::int64_t last_ticks_ = -1;
};

}  // namespace

Result<std::unique_ptr<Output>> open_film(const std::string& file, int sound_rate_hz) {
  av_log_set_level(AV_LOG_ERROR);
  // Refused now rather than with the first picture, minutes later.
  if (!std::ofstream(file, std::ios::binary | std::ios::trunc)) {
    return failure(ErrorCode::io, "cannot write film '" + file + "': " + std::strerror(errno));
  }
  return std::make_unique<Film>(file, sound_rate_hz);
}

}  // namespace counterpart
