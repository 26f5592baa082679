// Speech as samples.
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace counterpart {

struct Sound {
  int rate_hz = 22050;
  std::vector<std::int16_t> samples;  // one channel

  double duration_s() const { return static_cast<double>(samples.size()) / rate_hz; }
};

// A sound that may still be in the making. Null, when it is there: nobody can speak the text, and it is only shown.
using SoundToCome = std::shared_future<std::shared_ptr<const Sound>>;

inline SoundToCome ready_sound(std::shared_ptr<const Sound> sound) {
  std::promise<std::shared_ptr<const Sound>> promise;
  promise.set_value(std::move(sound));
  return promise.get_future().share();
}

// Speaks a text in a language ("en", "nl", ...).
using Speaker = std::function<SoundToCome(const std::string& text, const std::string& language)>;

}  // namespace counterpart
