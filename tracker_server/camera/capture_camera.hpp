// V4L2 devices, video files and network streams, read through OpenCV.
#pragma once

#include <opencv2/videoio.hpp>

#include "tracker_server/camera/camera.hpp"

namespace counterpart {

enum class CaptureKind : std::uint8_t { film = 1, device = 2, stream = 3 };

class CaptureCamera : public Camera {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Camera>> open(const std::string& uri, CaptureKind kind);

  // Frames of a film are stamped by number and frame rate, others by the monotonic clock on arrival.
  [[nodiscard]] Result<std::optional<Frame>> next() override;

 private:
  cv::VideoCapture capture_;
  std::string uri_;
  CaptureKind kind_ = CaptureKind::film;
  double frames_per_second_ = 25;
  FrameId next_id_ = 0;
};

}  // namespace counterpart
