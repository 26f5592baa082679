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
    ".text\n");

extern "C" const counterpart::PatternWeights counterpart_trained_weights;

namespace counterpart {

static_assert(sizeof(PatternWeights) == COUNTERPART_TRAINED_WEIGHTS_BYTES,
              "trained.weights has the wrong size; make it again with: draughts fit");
static_assert(std::endian::native == std::endian::little, "the file is little-endian");

const PatternWeights& built_in_weights() {
  return counterpart_trained_weights;
}

}  // namespace counterpart
