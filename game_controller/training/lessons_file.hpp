// Lessons as a file, so that a long series can be played in parts and learnt from in different ways.
#pragma once

#include <string>
#include <vector>

#include "game_controller/training/self_play.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

// Behind what the file holds; it is made if there is none.
[[nodiscard]] Result<void> append_lessons(const std::vector<Lesson>& lessons, const std::string& file);

// Fails with `not_found`, or `bad_format` and the number of the lesson that is none.
[[nodiscard]] Result<std::vector<Lesson>> read_lessons(const std::string& file);

}  // namespace counterpart
