#include "protocol/transport/outgoing.hpp"

#include "protocol/codec/codec.hpp"
#include "protocol/transport/jpeg.hpp"

namespace counterpart {
namespace {

Result<Bytes> body_of(const Message& message, PixelCodec codec) {
  const auto* video = std::get_if<VideoFrame>(&message);
  if (video == nullptr || video->codec == codec || codec == PixelCodec::raw_bgr8) return encode(message);
  auto compressed = convert(*video, codec);
  if (!compressed) return tl::make_unexpected(compressed.error());
  return encode(*compressed);
}

}  // namespace

Result<Outgoing> make_outgoing(const Message& message, PixelCodec codec) {
  auto body = body_of(message, codec);
  if (!body) return tl::make_unexpected(body.error());
  Outgoing outgoing;
  outgoing.type = type_of(message);
  outgoing.frame_id = frame_of(message);
  if (const auto* pose = std::get_if<PoseEstimate>(&message)) outgoing.object = pose->object_id;
  outgoing.body = std::make_shared<const Bytes>(std::move(*body));
  return outgoing;
}

}  // namespace counterpart
