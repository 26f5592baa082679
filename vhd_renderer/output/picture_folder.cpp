#include "vhd_renderer/output/picture_folder.hpp"

#include <cstdio>
#include <filesystem>

#include <opencv2/imgcodecs.hpp>

namespace counterpart {
namespace {

class PictureFolder final : public Output {
 public:
  explicit PictureFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  Result<void> write(const cv::Mat& bgr, std::int64_t /*stamp_ns*/) override {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%05d.png", count_++);
    const std::string path = (folder_ / name).string();
    // Level 1: four times as fast as the default, files a tenth larger.
    if (cv::imwrite(path, bgr, {cv::IMWRITE_PNG_COMPRESSION, 1})) return {};
    return failure(ErrorCode::io, "cannot write picture '" + path + "'; is the disk full?");
  }

  Result<void> finish() override { return {}; }

 private:
  std::filesystem::path folder_;
  int count_ = 0;
};

}  // namespace

Result<std::unique_ptr<Output>> open_picture_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    return failure(ErrorCode::io, "cannot make folder '" + folder + "': " + error.message());
  }
  return std::make_unique<PictureFolder>(folder);
}

}  // namespace counterpart
