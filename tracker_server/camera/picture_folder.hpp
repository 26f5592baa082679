// A folder of PNG or JPEG pictures as a camera: a SEQUENCE, or any pictures in name order. It has no clock of its own:
// the pictures are stamped as if they came at an even rate.
#pragma once

#include <filesystem>
#include <vector>

#include "tracker_server/camera/camera.hpp"

namespace counterpart {

class PictureFolder : public Camera {
 public:
  // Fails if there is no picture in it, or if the camera.json beside them is bad.
  [[nodiscard]] static Result<std::unique_ptr<Camera>> open(const std::filesystem::path& folder,
                                                            double frames_per_second = 15);

  // A picture that cannot be decoded ends the camera with a failure that names the file.
  [[nodiscard]] Result<std::optional<Frame>> next() override;
  std::optional<Intrinsics> intrinsics() const override { return intrinsics_; }

 private:
  std::vector<std::filesystem::path> pictures_;
  std::optional<Intrinsics> intrinsics_;
  double frames_per_second_ = 15;
  std::size_t position_ = 0;
};

}  // namespace counterpart
