// Sound as the bytes of a WAV file of one channel with 16 bits.
#pragma once

#include <string>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/voice/sound.hpp"

namespace counterpart {

// A length of "unknown", as streams have, is taken for all there is.
Result<Sound> decode_wav(const std::string& bytes);

std::string encode_wav(const Sound& sound);

}  // namespace counterpart
