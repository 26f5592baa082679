// The game on disk, so that it outlives this process.
#pragma once

#include <optional>
#include <string>

#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// Replaces a file in one step: readers see the old or the new content, never a half of either.
[[nodiscard]] Result<void> replace_file(const std::string& file, const std::string& text);

[[nodiscard]] Result<void> save_game(const std::string& folder, const std::string& text);

// Empty if the folder holds no game.
[[nodiscard]] Result<std::optional<std::string>> load_game(const std::string& folder);

}  // namespace counterpart
