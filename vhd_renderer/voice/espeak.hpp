// Speech by espeak-ng, run as a program of its own: its licence (GPL-3) stays its own, and a text that it stumbles over
// takes nobody down with it.
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>

#include "protocol/vocabulary/result.hpp"
#include "vhd_renderer/voice/sound.hpp"

namespace counterpart {

// Tens of milliseconds for a sentence. Fails if espeak-ng is not there, does not know the language, takes over five
// seconds, or is told to stop. `variant`: one of its voice variants ("m3", "f2"), or empty.
Result<Sound> speak(const std::string& text, const std::string& language, const std::string& variant = {},
                    const std::string& program = "espeak-ng", const std::stop_token& stop = {});

enum class Speaking : std::uint8_t {
  at_once,            // the speaker returns when the sound is there: the same in every run
  in_the_background,  // it returns at once, and a thread of its own speaks: no frame waits for it
};

// Remembers what it has said; the first failure is told as a warning, after it the words are only shown.
Speaker espeak_speaker(const std::string& variant, Speaking speaking, const std::string& program = "espeak-ng");

}  // namespace counterpart
