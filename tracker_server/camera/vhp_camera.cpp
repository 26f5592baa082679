#include "tracker_server/camera/vhp_camera.hpp"

#include <deque>
#include <string>
#include <utility>

#include "protocol/daemon/stop_signal.hpp"
#include "protocol/h264/h264.hpp"
#include "protocol/transport/endpoint.hpp"
#include "protocol/transport/jpeg.hpp"

namespace counterpart {
namespace {

constexpr std::int64_t kLookNs = 100'000'000;  // how often a waiting camera looks for Ctrl-C

Result<cv::Mat> to_picture(const VideoFrame& video) {
  auto raw = convert(video, PixelCodec::raw_bgr8);
  if (!raw) return tl::make_unexpected(raw.error());
  return cv::Mat(raw->height, raw->width, CV_8UC3, raw->bytes.data(), raw->stride).clone();
}

class VhpCamera final : public Camera {
 public:
  VhpCamera(std::unique_ptr<Endpoint> link, Pace pace) : link_(std::move(link)), pace_(pace) {}

  Result<std::optional<Frame>> next() override {
    while (!stop_requested()) {
      hear(waiting_.empty() ? kLookNs : 0);
      if (pace_ == Pace::realtime) {
        for (; waiting_.size() > 1; waiting_.pop_front()) ++dropped_;
      }
      if (!waiting_.empty()) return take();
      if (ended_) return std::nullopt;
    }
    return std::nullopt;
  }

  std::optional<Intrinsics> intrinsics() const override { return intrinsics_; }
  std::uint64_t dropped() const override { return dropped_; }
  void done(const FrameStamp& stamp) override { link_->broadcast(FrameDone{stamp}); }
  void tell(const Message& message) override { link_->broadcast(message); }

 private:
  void hear(std::int64_t timeout_ns) {
    for (Inbound& inbound : link_->receive(timeout_ns)) {
      if (const auto* left = std::get_if<PeerLeft>(&inbound)) ended_ = ended_ || left->said_goodbye;
      if (const auto* joined = std::get_if<PeerJoined>(&inbound); joined != nullptr && !joined->resumed) ended_ = false;
      auto* received = std::get_if<Received>(&inbound);
      if (received == nullptr) continue;  // a lost link comes back by itself
      if (auto* video = std::get_if<VideoFrame>(&received->message)) {
        waiting_.push_back(std::move(*video));
      } else if (const auto* intrinsics = std::get_if<Intrinsics>(&received->message)) {
        intrinsics_ = *intrinsics;
      }
    }
  }

  Result<std::optional<Frame>> take() {
    const VideoFrame video = std::move(waiting_.front());
    waiting_.pop_front();
    auto picture = to_picture(video);
    if (!picture) return tl::make_unexpected(picture.error());
    return Frame{video.stamp, *picture};
  }

  std::unique_ptr<Endpoint> link_;
  Pace pace_;
  std::deque<VideoFrame> waiting_;
  std::optional<Intrinsics> intrinsics_;
  std::uint64_t dropped_ = 0;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<Camera> make_vhp_camera(std::unique_ptr<Endpoint> link, Pace pace) {
  return std::make_unique<VhpCamera>(std::move(link), pace);
}

Result<std::unique_ptr<Camera>> open_vhp_camera(const std::string& host_port, Pace pace, const CameraAccess& access,
                                                std::int64_t wait_ns) {
  LinkOptions options;
  options.role = Role::tracker;
  options.software = "tracker_server " COUNTERPART_VERSION;
  options.lockstep = pace == Pace::lockstep;
  options.token_file = access.token_file;
  options.tls_file = access.tls_file;
  use_h264(options);
  auto link = connect_tcp(host_port, options, wait_ns);
  if (!link) {
    const bool lacks_file = link.error().message.find("-file") != std::string::npos;
    return failure(link.error().code,
                   "the camera vhp://" + host_port + ": " + link.error().message +
                       (lacks_file ? " (for a camera: --camera-token-file, --camera-tls-file)" : ""));
  }
  return make_vhp_camera(std::move(*link), pace);
}

}  // namespace counterpart
