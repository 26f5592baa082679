#include "protocol/transport/jpeg.hpp"

#include <memory>

#include <turbojpeg.h>

namespace counterpart {
namespace {

using Handle = std::unique_ptr<void, int (*)(tjhandle)>;

Result<VideoFrame> compress(const VideoFrame& frame, int quality) {
  const Handle handle(tjInitCompress(), tjDestroy);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int done = tjCompress2(handle.get(), frame.bytes.data(), frame.width, static_cast<int>(frame.stride),
                               frame.height, TJPF_BGR, &bytes, &size, TJSAMP_420, quality, TJFLAG_FASTDCT);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(bytes, tjFree);
  if (done != 0)
    return failure(ErrorCode::internal, std::string("a picture cannot be compressed: ") + tjGetErrorStr2(handle.get()));
  VideoFrame out;
  out.stamp = frame.stamp;
  out.codec = PixelCodec::jpeg;
  out.width = frame.width;
  out.height = frame.height;
  out.bytes.assign(bytes, bytes + size);
  return out;
}

Result<VideoFrame> expand(const VideoFrame& frame) {
  const Handle handle(tjInitDecompress(), tjDestroy);
  int width = 0, height = 0, subsampling = 0, colours = 0;
  const auto size = static_cast<unsigned long>(frame.bytes.size());
  if (tjDecompressHeader3(handle.get(), frame.bytes.data(), size, &width, &height, &subsampling, &colours) != 0 ||
      width != frame.width || height != frame.height) {
    return failure(ErrorCode::bad_format, "a picture is not a JPEG of the size that was announced");
  }
  VideoFrame out;
  out.stamp = frame.stamp;
  out.codec = PixelCodec::raw_bgr8;
  out.width = frame.width;
  out.height = frame.height;
  out.stride = 3U * frame.width;
  out.bytes.resize(std::size_t{out.stride} * out.height);
  if (tjDecompress2(handle.get(), frame.bytes.data(), size, out.bytes.data(), width, static_cast<int>(out.stride),
                    height, TJPF_BGR, TJFLAG_STOPONWARNING) != 0) {
    return failure(ErrorCode::bad_format, std::string("a JPEG picture is damaged: ") + tjGetErrorStr2(handle.get()));
  }
  return out;
}

}  // namespace

Result<VideoFrame> convert(const VideoFrame& frame, PixelCodec codec, int quality) {
  if (frame.codec == codec) return frame;
  if (frame.codec == PixelCodec::h264 || codec == PixelCodec::h264) {
    return failure(ErrorCode::unsupported, "one picture alone cannot be turned into H.264, or from it");
  }
  return codec == PixelCodec::jpeg ? compress(frame, quality) : expand(frame);
}

}  // namespace counterpart
