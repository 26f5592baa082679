#include <cstring>
#include <string>
#include <vector>

#include "protocol/h264/ffmpeg_handles.hpp"
#include "protocol/h264/h264.hpp"

namespace counterpart {
namespace {

constexpr int kAlignment = 64;  // a codec's own pictures are a little larger

Error damaged(const std::string& what) {
  return {ErrorCode::bad_format, "a picture in H.264 is damaged: " + what};
}

class H264Decoder final : public VideoDecoder {
 public:
  Result<std::optional<VideoFrame>> decode(const VideoFrame& coded) override {
    const bool key = coded.stride == 0;
    if (!key && (!last_ || *last_ + coded.stride != coded.stamp.frame_id)) return std::nullopt;
    last_.reset();  // until it has been read
    if (key && !open(coded)) return failure(ErrorCode::internal, "this FFmpeg cannot read H.264");
    if (coded.width != width_ || coded.height != height_) return tl::make_unexpected(damaged("its size changed"));
    if (auto read = read_picture(coded.bytes); !read) return tl::make_unexpected(read.error());
    last_ = coded.stamp.frame_id;
    VideoFrame raw;
    raw.stamp = coded.stamp;
    raw.codec = PixelCodec::raw_bgr8;
    raw.width = width_;
    raw.height = height_;
    raw.stride = 3U * width_;
    raw.bytes.resize(std::size_t{raw.stride} * height_);
    std::uint8_t* target[] = {raw.bytes.data()};
    const int target_stride[] = {static_cast<int>(raw.stride)};
    sws_scale(scaler_.get(), frame_->data, frame_->linesize, 0, height_, target, target_stride);
    return raw;
  }

 private:
  bool open(const VideoFrame& coded) {
    if (codec_ != nullptr && coded.width == width_ && coded.height == height_) return true;
    width_ = height_ = 0;
    const AVCodec* decoder = avcodec_find_decoder(AV_CODEC_ID_H264);
    if (decoder == nullptr) return false;
    codec_.reset(avcodec_alloc_context3(decoder));
    codec_->thread_count = 1;  // more would hold pictures back
    codec_->flags |= AV_CODEC_FLAG_LOW_DELAY;
    codec_->err_recognition = AV_EF_EXPLODE;
    codec_->max_pixels = std::int64_t{coded.width + kAlignment} * (coded.height + kAlignment);
    if (avcodec_open2(codec_.get(), decoder, nullptr) < 0) return false;
    packet_.reset(av_packet_alloc());
    frame_.reset(av_frame_alloc());
    scaler_.reset(sws_getContext(coded.width, coded.height, AV_PIX_FMT_YUV420P, coded.width, coded.height,
                                 AV_PIX_FMT_BGR24, SWS_BILINEAR | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
    if (scaler_ == nullptr) return false;
    width_ = coded.width;
    height_ = coded.height;
    return true;
  }

  // Into frame_. The codec reads a little beyond the end, so the bytes are copied and followed by zeros.
  Result<void> read_picture(const std::vector<std::uint8_t>& bytes) {
    if (av_new_packet(packet_.get(), static_cast<int>(bytes.size())) < 0) {
      return failure(ErrorCode::internal, "out of memory for a picture");
    }
    std::memcpy(packet_->data, bytes.data(), bytes.size());
    const int sent = avcodec_send_packet(codec_.get(), packet_.get());
    av_packet_unref(packet_.get());
    if (sent < 0) return tl::make_unexpected(damaged("it cannot be read"));
    if (avcodec_receive_frame(codec_.get(), frame_.get()) < 0) return tl::make_unexpected(damaged("nothing is in it"));
    const bool fits = frame_->width - width_ >= 0 && frame_->width - width_ <= 1 && frame_->height - height_ >= 0 &&
                      frame_->height - height_ <= 1 && frame_->format == AV_PIX_FMT_YUV420P;
    if (!fits) return tl::make_unexpected(damaged("it is not of the size and kind that was announced"));
    return {};
  }

  std::unique_ptr<AVCodecContext, CodecDeleter> codec_;
  std::unique_ptr<AVFrame, FrameDeleter> frame_;
  std::unique_ptr<AVPacket, PacketDeleter> packet_;
  std::unique_ptr<SwsContext, ScalerDeleter> scaler_;
  std::uint16_t width_ = 0, height_ = 0;  // 0: not open
  std::optional<FrameId> last_;           // what the next one may build on
};

}  // namespace

std::unique_ptr<VideoDecoder> make_h264_decoder() {
  av_log_set_level(AV_LOG_FATAL);  // what is wrong is said by the result
  return std::make_unique<H264Decoder>();
}

void use_h264(LinkOptions& options) {
  options.takes_h264 = true;
  options.h264 = {make_h264_encoder, make_h264_decoder};
}

}  // namespace counterpart
