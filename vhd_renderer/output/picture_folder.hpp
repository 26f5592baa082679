// The mirror as a folder of PNG pictures, frame_00000.png and on.
#pragma once

#include <memory>
#include <string>

#include "vhd_renderer/output/output.hpp"

namespace counterpart {

[[nodiscard]] Result<std::unique_ptr<Output>> open_picture_folder(const std::string& folder);

}  // namespace counterpart
