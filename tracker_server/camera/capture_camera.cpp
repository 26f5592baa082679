#include "tracker_server/camera/capture_camera.hpp"

#include <chrono>

namespace counterpart {
namespace {

std::int64_t monotonic_ns() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

}  // namespace

Result<std::unique_ptr<Camera>> CaptureCamera::open(const std::string& uri, CaptureKind kind) {
  auto camera = std::make_unique<CaptureCamera>();
  camera->uri_ = uri;
  camera->kind_ = kind;
  camera->capture_.open(uri, kind == CaptureKind::device ? cv::CAP_V4L2 : cv::CAP_FFMPEG);
  if (!camera->capture_.isOpened()) {
    switch (kind) {
      case CaptureKind::device:
        return failure(ErrorCode::unavailable, "Cannot open the camera " + uri +
                                                   ": is it in use by another program, or not readable for this user?");
      case CaptureKind::stream:
        return failure(ErrorCode::unavailable, "Cannot open the stream " + uri + ": is its server running?");
      case CaptureKind::film:
        break;
    }
    return failure(ErrorCode::bad_format, "Cannot read " + uri +
                                              " as a video file; it may be cut off or of a format "
                                              "that FFmpeg does not know.");
  }
  const double rate = camera->capture_.get(cv::CAP_PROP_FPS);
  if (rate > 0.1 && rate < 1000) camera->frames_per_second_ = rate;
  return camera;
}

Result<std::optional<Frame>> CaptureCamera::next() {
  cv::Mat picture;
  if (!capture_.read(picture) || picture.empty()) {
    if (next_id_ == 0) return failure(ErrorCode::bad_format, "No frame could be decoded from " + uri_ + ".");
    if (kind_ == CaptureKind::device)
      return failure(ErrorCode::closed, "The camera " + uri_ + " stopped giving frames; was it unplugged?");
    return std::optional<Frame>{};
  }
  Frame frame;
  frame.image_bgr = picture.clone();  // OpenCV reuses its buffer
  frame.stamp.frame_id = next_id_;
  frame.stamp.capture_ns = kind_ == CaptureKind::film
                               ? static_cast<std::int64_t>(1e9 * static_cast<double>(next_id_) / frames_per_second_)
                               : monotonic_ns();
  ++next_id_;
  return std::optional<Frame>{std::move(frame)};
}

}  // namespace counterpart
