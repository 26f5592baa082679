#include "protocol/transport/outgoing.hpp"

#include <utility>

#include "protocol/codec/codec.hpp"
#include "protocol/transport/jpeg.hpp"

namespace counterpart {
namespace {

Result<void> write_body(const Message& message, const VideoForm& form, Bytes& out) {
  const auto* video = std::get_if<VideoFrame>(&message);
  if (video == nullptr || video->codec == form.codec || form.codec == PixelCodec::raw_bgr8) return encode(message, out);
  auto compressed = convert(*video, form.codec, form.quality);
  if (!compressed) return tl::make_unexpected(compressed.error());
  return encode(*compressed, out);
}

}  // namespace

Result<Outgoing> make_outgoing(const Message& message, const VideoForm& form, std::shared_ptr<Bytes> memory) {
  if (auto written = write_body(message, form, *memory); !written) return tl::make_unexpected(written.error());
  Outgoing outgoing;
  outgoing.type = type_of(message);
  outgoing.frame_id = frame_of(message);
  if (const auto* pose = std::get_if<PoseEstimate>(&message)) outgoing.object = pose->object_id;
  outgoing.body = std::move(memory);
  return outgoing;
}

}  // namespace counterpart
