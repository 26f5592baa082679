// FFmpeg's objects, freed when they go.
#pragma once

#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

namespace counterpart {

struct FormatDeleter {
  void operator()(AVFormatContext* format) const {
    if (format->pb != nullptr) avio_closep(&format->pb);
    avformat_free_context(format);
  }
};
struct CodecDeleter {
  void operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
};
struct FrameDeleter {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct PacketDeleter {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
struct ScalerDeleter {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

// Gives `frame` (null: flushes) to an encoder and what comes out of it to the file; returns FFmpeg's code, 0 or below.
inline int encode_into(AVFormatContext& format, AVCodecContext& codec, const AVStream& stream, AVPacket& packet,
                       const AVFrame* frame) {
  if (const int code = avcodec_send_frame(&codec, frame); code < 0) return code;
  for (;;) {
    const int code = avcodec_receive_packet(&codec, &packet);
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return 0;
    if (code < 0) return code;
    av_packet_rescale_ts(&packet, codec.time_base, stream.time_base);
    packet.stream_index = stream.index;
    if (const int written = av_interleaved_write_frame(&format, &packet); written < 0) return written;
  }
}

}  // namespace counterpart
