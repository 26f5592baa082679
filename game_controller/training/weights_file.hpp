// Weights as a file: the 16-bit numbers as they lie in PatternWeights, little-endian, nothing else.
#pragma once

#include <memory>
#include <string>

#include "game_controller/engine/patterns.hpp"
#include "protocol/vocabulary/result.hpp"

namespace counterpart {

[[nodiscard]] Result<void> write_weights(const PatternWeights& weights, const std::string& file);
[[nodiscard]] Result<std::unique_ptr<PatternWeights>> read_weights(const std::string& file);

}  // namespace counterpart
