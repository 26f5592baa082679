#include <cstdlib>
#include <limits>
#include <string>

extern "C" {
#include <libavutil/opt.h>
}

#include "protocol/h264/ffmpeg_handles.hpp"
#include "protocol/h264/h264.hpp"

namespace counterpart {
namespace {

constexpr int kPicturesPerSecond = 25;  // what x264 is told; the wish counts by pictures
constexpr int kBurst = 6;               // pictures' worth that one may take: a quarter of a second
constexpr int kMostBuilding = 50;       // pictures: whoever finds a capture cut anywhere waits no longer

const AVCodec* find_encoder() {
  return avcodec_find_encoder_by_name("libx264");
}

class H264Encoder final : public VideoEncoder {
 public:
  Result<VideoFrame> encode(const VideoFrame& raw, const Wish& wish) override {
    if (raw.codec != PixelCodec::raw_bgr8) {
      return failure(ErrorCode::invalid_argument, "only raw pictures can be turned into H.264");
    }
    const bool other_size = raw.width != width_ || raw.height != height_;
    if (other_size) {
      if (const int code = open(raw, wish.bits_a_picture); code < 0) return trouble(code);
    }
    limit(wish.bits_a_picture);
    if (const int code = av_frame_make_writable(frame_.get()); code < 0) return trouble(code);
    const std::uint8_t* source[] = {raw.bytes.data()};
    const int source_stride[] = {static_cast<int>(raw.stride)};
    sws_scale(scaler_.get(), source, source_stride, 0, raw.height, frame_->data, frame_->linesize);
    const bool afresh = other_size || wish.afresh || !follows(raw.stamp.frame_id);
    frame_->pict_type = afresh ? AV_PICTURE_TYPE_I : AV_PICTURE_TYPE_NONE;
    ++frame_->pts;
    if (const int code = avcodec_send_frame(codec_.get(), frame_.get()); code < 0) return trouble(code);
    // Without look-ahead each picture comes out at once.
    if (const int code = avcodec_receive_packet(codec_.get(), packet_.get()); code < 0) return trouble(code);
    return taken(raw);
  }

 private:
  // A number of frames back must fit a u32, and 0 says something else.
  bool follows(FrameId frame) const {
    return frame > last_ && frame - last_ <= std::numeric_limits<std::uint32_t>::max();
  }

  int open(const VideoFrame& raw, std::int64_t bits_a_picture) {
    width_ = raw.width;
    height_ = raw.height;
    const AVCodec* encoder = find_encoder();
    if (encoder == nullptr) return AVERROR_ENCODER_NOT_FOUND;
    codec_.reset(avcodec_alloc_context3(encoder));
    codec_->width = (width_ + 1) & ~1;  // what is too much is cut off again when it is read
    codec_->height = (height_ + 1) & ~1;
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->colorspace = AVCOL_SPC_SMPTE170M;
    codec_->color_range = AVCOL_RANGE_MPEG;
    codec_->time_base = {1, kPicturesPerSecond};
    codec_->framerate = {kPicturesPerSecond, 1};
    codec_->gop_size = kMostBuilding;
    codec_->thread_count = 1;  // the same bytes each time, and the other cores are the tracker's
    av_opt_set(codec_->priv_data, "preset", "superfast", 0);
    av_opt_set(codec_->priv_data, "tune", "zerolatency", 0);
    av_opt_set(codec_->priv_data, "crf", "20", 0);
    av_opt_set(codec_->priv_data, "aq-mode", "none", 0);  // it would give flat walls, and their noise, more than faces
    av_opt_set(codec_->priv_data, "forced-idr", "1", 0);
    set_limit(bits_a_picture);
    if (const int code = avcodec_open2(codec_.get(), encoder, nullptr); code < 0) return code;
    packet_.reset(av_packet_alloc());
    frame_.reset(av_frame_alloc());
    frame_->format = codec_->pix_fmt;
    frame_->width = codec_->width;
    frame_->height = codec_->height;
    frame_->pts = 0;
    if (const int code = av_frame_get_buffer(frame_.get(), 0); code < 0) return code;
    scaler_.reset(sws_getContext(width_, height_, AV_PIX_FMT_BGR24, width_, height_, codec_->pix_fmt, SWS_BILINEAR,
                                 nullptr, nullptr, nullptr));
    return scaler_ == nullptr ? AVERROR(ENOMEM) : 0;
  }

  // Small changes are not worth setting up the rate control anew.
  void limit(std::int64_t bits_a_picture) {
    const std::int64_t now = codec_->rc_max_rate / kPicturesPerSecond;
    if (std::abs(bits_a_picture - now) > now / 8) set_limit(bits_a_picture);
  }

  void set_limit(std::int64_t bits_a_picture) {
    codec_->rc_max_rate = bits_a_picture * kPicturesPerSecond;
    codec_->rc_buffer_size = static_cast<int>(bits_a_picture * kBurst);
  }

  VideoFrame taken(const VideoFrame& raw) {
    const bool key = (packet_->flags & AV_PKT_FLAG_KEY) != 0;
    VideoFrame out;
    out.stamp = raw.stamp;
    out.codec = PixelCodec::h264;
    out.width = width_;
    out.height = height_;
    out.stride = key ? 0 : static_cast<std::uint32_t>(raw.stamp.frame_id - last_);
    out.bytes.assign(packet_->data, packet_->data + packet_->size);
    av_packet_unref(packet_.get());
    last_ = raw.stamp.frame_id;
    return out;
  }

  Result<VideoFrame> trouble(int code) {
    width_ = height_ = 0;  // the next picture begins anew
    return failure(ErrorCode::internal, "a picture cannot be turned into H.264: " + ffmpeg_reason(code));
  }

  std::unique_ptr<AVCodecContext, CodecDeleter> codec_;
  std::unique_ptr<AVFrame, FrameDeleter> frame_;
  std::unique_ptr<AVPacket, PacketDeleter> packet_;
  std::unique_ptr<SwsContext, ScalerDeleter> scaler_;
  std::uint16_t width_ = 0, height_ = 0;  // 0: not open
  FrameId last_ = 0;
};

}  // namespace

std::unique_ptr<VideoEncoder> make_h264_encoder() {
  av_log_set_level(AV_LOG_FATAL);  // what is wrong is said by the result
  return find_encoder() == nullptr ? nullptr : std::make_unique<H264Encoder>();
}

}  // namespace counterpart
