#include "game_controller/training/weights_file.hpp"

#include <fstream>
#include <vector>

namespace counterpart {

Result<void> write_weights(const PatternWeights& weights, const std::string& file) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(&weights), sizeof weights);
  out.flush();
  if (!out) return failure(ErrorCode::io, "The weights could not be written to " + file + ".");
  return {};
}

Result<std::unique_ptr<PatternWeights>> read_weights(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(ErrorCode::not_found, "There is no file of weights " + file + ".");
  auto weights = std::make_unique<PatternWeights>();
  in.read(reinterpret_cast<char*>(weights.get()), sizeof *weights);
  if (in.gcount() != sizeof *weights || in.peek() != std::ifstream::traits_type::eof()) {
    return failure(ErrorCode::bad_format,
                   file + " is no file of weights: it must be " + std::to_string(sizeof *weights) + " bytes long.");
  }
  return weights;
}

}  // namespace counterpart
