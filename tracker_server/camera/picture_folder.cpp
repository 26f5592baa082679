#include "tracker_server/camera/picture_folder.hpp"

#include <algorithm>
#include <cctype>

#include <opencv2/imgcodecs.hpp>

#include "tracker_server/camera/camera_json.hpp"

namespace counterpart {
namespace {

bool is_picture(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg";
}

}  // namespace

Result<std::unique_ptr<Camera>> PictureFolder::open(const std::filesystem::path& folder, double frames_per_second) {
  auto camera = std::make_unique<PictureFolder>();
  camera->frames_per_second_ = frames_per_second;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.is_regular_file() && is_picture(entry.path())) camera->pictures_.push_back(entry.path());
  if (error) return failure(ErrorCode::io, "Cannot read the folder " + folder.string() + ": " + error.message() + ".");
  if (camera->pictures_.empty())
    return failure(ErrorCode::not_found, "No .png or .jpg picture in the folder " + folder.string() + ".");
  std::sort(camera->pictures_.begin(), camera->pictures_.end());

  if (const auto json = folder / "camera.json"; std::filesystem::exists(json)) {
    const auto intrinsics = read_camera_json(json);
    if (!intrinsics) return tl::make_unexpected(intrinsics.error());
    camera->intrinsics_ = *intrinsics;
  }
  return camera;
}

Result<std::optional<Frame>> PictureFolder::next() {
  if (position_ == pictures_.size()) return std::optional<Frame>{};
  const auto& path = pictures_[position_];
  Frame frame;
  frame.image_bgr = cv::imread(path.string(), cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  if (frame.image_bgr.empty())
    return failure(ErrorCode::bad_format, "Cannot decode the picture " + path.string() + "; it may be cut off.");
  const int width = frame.image_bgr.cols, height = frame.image_bgr.rows;
  if (intrinsics_ && (width != intrinsics_->width || height != intrinsics_->height)) {
    const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
    return failure(ErrorCode::bad_format, "The picture " + path.string() + " is " + size(width, height) +
                                              ", but camera.json beside it tells of a camera of " +
                                              size(intrinsics_->width, intrinsics_->height) + ".");
  }
  frame.stamp.frame_id = position_;
  frame.stamp.capture_ns = static_cast<std::int64_t>(1e9 * static_cast<double>(position_) / frames_per_second_);
  ++position_;
  return std::optional<Frame>{std::move(frame)};
}

}  // namespace counterpart
