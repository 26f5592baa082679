// Speech as samples.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace counterpart {

struct Sound {
  int rate_hz = 22050;
  std::vector<std::int16_t> samples;  // one channel

  double duration_s() const { return static_cast<double>(samples.size()) / rate_hz; }
};

// Speaks a text in a language ("en", "nl", ...); null: nobody can, and the words are only shown.
using Speaker = std::function<std::shared_ptr<const Sound>(const std::string& text, const std::string& language)>;

}  // namespace counterpart
