// Where pictures come from. A camera is anything that gives frames in order until it ends.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/intrinsics.hpp"
#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/result.hpp"
#include "protocol/vocabulary/stamp.hpp"

namespace counterpart {

struct Frame {
  FrameStamp stamp;
  cv::Mat image_bgr;  // CV_8UC3, owned by this frame alone
};

enum class Pace {
  realtime = 1,  // the newest frame wins, older ones are dropped and counted
  lockstep = 2,  // every frame in order, as fast as it is asked for
};

class Camera {
 public:
  virtual ~Camera() = default;

  // The next frame; waits for it. Empty: the camera has ended. A failure is final and says what to do.
  [[nodiscard]] virtual Result<std::optional<Frame>> next() = 0;

  // What the source knows of its lens (camera.json, INTRINSICS); empty if it must be estimated.
  virtual std::optional<Intrinsics> intrinsics() const { return std::nullopt; }

  virtual std::uint64_t dropped() const { return 0; }

  // For a camera host that plays along (the stage, a capture being replayed): this frame has been composited, the next
  // one may come; and what is shown in the mirror (events, board states). Other cameras do not listen.
  virtual void done(const FrameStamp& /*stamp*/) {}
  virtual void tell(const Message& /*message*/) {}
};

// What opens a camera host (vhp://): the files that it was started with, too. Other cameras need nothing.
struct CameraAccess {
  std::string token_file;
  std::string tls_file;
};

// uri: /dev/videoN, a video file, a folder of pictures (name order; camera.json beside them is read), rtsp://, http://
// or vhp://. Names missing files and devices, and what could be opened instead.
[[nodiscard]] Result<std::unique_ptr<Camera>> open_camera(const std::string& uri, Pace pace,
                                                          const CameraAccess& access = {});

}  // namespace counterpart
