#include <filesystem>

#include "tracker_server/camera/camera.hpp"
#include "tracker_server/camera/capture_camera.hpp"
#include "tracker_server/camera/newest_wins.hpp"
#include "tracker_server/camera/picture_folder.hpp"
#include "tracker_server/camera/vhp_camera.hpp"

namespace counterpart {
namespace {

constexpr const char* kinds =
    "a camera is /dev/videoN, a video file, a folder of pictures, rtsp://... or http://..., or vhp://HOST:PORT";

bool starts_with_any(const std::string& text, std::initializer_list<const char*> prefixes) {
  for (const char* prefix : prefixes)
    if (text.rfind(prefix, 0) == 0) return true;
  return false;
}

Result<std::unique_ptr<Camera>> open_source(const std::string& uri) {
  if (uri.empty()) return failure(ErrorCode::invalid_argument, std::string("No camera given; ") + kinds + ".");
  if (starts_with_any(uri, {"rtsp://", "rtsps://", "http://", "https://"}))
    return CaptureCamera::open(uri, CaptureKind::stream);
  std::error_code error;
  const auto status = std::filesystem::status(uri, error);
  if (std::filesystem::is_directory(status)) return PictureFolder::open(uri);
  if (std::filesystem::is_character_file(status)) return CaptureCamera::open(uri, CaptureKind::device);
  if (std::filesystem::is_regular_file(status)) return CaptureCamera::open(uri, CaptureKind::film);
  return failure(ErrorCode::not_found, "There is no camera, film or folder " + uri + "; " + kinds + ".");
}

}  // namespace

Result<std::unique_ptr<Camera>> open_camera(const std::string& uri, Pace pace, const CameraAccess& access) {
  constexpr std::int64_t kPatienceNs = 10'000'000'000;  // a camera host that is just starting gets this long
  if (starts_with_any(uri, {"vhp://"})) return open_vhp_camera(uri.substr(6), pace, access, kPatienceNs);
  auto source = open_source(uri);
  if (!source || pace == Pace::lockstep) return source;
  return newest_wins(std::move(*source));
}

}  // namespace counterpart
