#include <bit>

#include "game_controller/engine/patterns.hpp"

// The file as it is, by the assembler: the compiler need not read a hundred thousand numbers.
__asm__(
    ".section .rodata\n"
    ".balign 16\n"
    ".type counterpart_trained_weights, %object\n"
    "counterpart_trained_weights:\n"
    ".incbin \"" COUNTERPART_TRAINED_WEIGHTS
    "\"\n"
    "counterpart_trained_weights_end:\n"
    ".if counterpart_trained_weights_end - counterpart_trained_weights - 341200\n"
    ".error \"trained.weights has the wrong size; make it again with: draughts train\"\n"
    ".endif\n"
    ".text\n");

extern "C" const counterpart::PatternWeights counterpart_trained_weights;

namespace counterpart {

static_assert(sizeof(PatternWeights) == 341'200, "the size above");
static_assert(std::endian::native == std::endian::little, "the file is little-endian");

const PatternWeights& built_in_weights() {
  return counterpart_trained_weights;
}

}  // namespace counterpart
