// What a file takes besides protocol/h264's objects of FFmpeg.
#pragma once

extern "C" {
#include <libavformat/avformat.h>
}

#include "protocol/h264/ffmpeg_handles.hpp"

namespace counterpart {

struct FormatDeleter {
  void operator()(AVFormatContext* format) const {
    if (format->pb != nullptr) avio_closep(&format->pb);
    avformat_free_context(format);
  }
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
