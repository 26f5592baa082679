#include "protocol/transport/outgoing.hpp"

#include <utility>

#include "protocol/codec/codec.hpp"
#include "protocol/transport/jpeg.hpp"

namespace counterpart {
namespace {

Result<void> write_body(const Message& message, const VideoForm& form, Bytes& out) {
  const auto* video = std::get_if<VideoFrame>(&message);
  const bool as_it_is = video == nullptr || video->codec != PixelCodec::raw_bgr8 || form.codec == PixelCodec::raw_bgr8;
  if (as_it_is) return encode(message, out);
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
  const auto* video = std::get_if<VideoFrame>(&message);
  if (video != nullptr && video->codec == PixelCodec::h264) {
    outgoing.chain = video->stride == 0 ? Chain::begins : Chain::goes_on;
  }
  outgoing.body = std::move(memory);
  return outgoing;
}

}  // namespace counterpart
