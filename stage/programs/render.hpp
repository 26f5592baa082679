// `stage render`: a scenario as a folder of pictures.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "protocol/vocabulary/result.hpp"

namespace counterpart::stage {

struct RenderOptions {
  std::string scenario;
  std::string out;
  std::optional<std::uint64_t> seed;
  std::optional<int> frames;
  int from = 0;  // first frame to draw
  bool masks = false;
};

[[nodiscard]] Result<void> run_render(const RenderOptions& options, const std::function<bool()>& stop_requested);

}  // namespace counterpart::stage
