#include "vhd_renderer/output/output.hpp"

#include <filesystem>

#include "vhd_renderer/output/film.hpp"
#include "vhd_renderer/output/picture_folder.hpp"

namespace counterpart {

void Output::hear(std::shared_ptr<const Sound>, double) {}

Result<std::unique_ptr<Output>> open_output(const std::string& target, int sound_rate_hz) {
  const std::filesystem::path path(target);
  if (path.extension() == ".mp4") return open_film(target, sound_rate_hz);
  if (path.has_extension() && !std::filesystem::is_directory(path)) {
    return failure(ErrorCode::unsupported,
                   "cannot write '" + target + "': give a name ending in .mp4, or a folder for PNG pictures");
  }
  return open_picture_folder(target);
}

}  // namespace counterpart
