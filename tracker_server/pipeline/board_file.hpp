// board.json: the sizes of a board, any of the fields of BoardGeometry by their names.
#pragma once

#include <filesystem>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// What the file does not name is as BoardGeometry has it. Failures name the field and what is allowed there.
[[nodiscard]] Result<BoardGeometry> read_board_file(const std::filesystem::path& path);

}  // namespace counterpart
