#include "vhd_renderer/motion/speech.hpp"

#include <algorithm>
#include <cctype>

#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

MouthShape shape_of(char letter) {
  switch (letter) {
    case 'a':
      return {0.75F, 0.1F, 0, 0};
    case 'e':
      return {0.45F, 0.45F, 0, 0};
    case 'i':
    case 'y':
      return {0.28F, 0.6F, 0, 0};
    case 'o':
      return {0.55F, 0, 0.55F, 0};
    case 'u':
    case 'w':
    case 'q':
      return {0.25F, 0, 0.8F, 0};
    case 'm':
    case 'b':
    case 'p':
      return {0, 0, 0, 1};
    case 'f':
    case 'v':
      return {0.08F, 0.15F, 0, 0.45F};
    case 'l':
    case 'd':
    case 't':
    case 'n':
      return {0.25F, 0.2F, 0, 0};
    case 's':
    case 'z':
    case 'c':
    case 'x':
      return {0.1F, 0.4F, 0, 0};
    default:
      return {0.2F, 0.1F, 0.05F, 0};
  }
}

}  // namespace

Utterance::Utterance(const std::string& text) {
  double t = 0.05;
  for (const char raw : text) {
    const auto byte = static_cast<unsigned char>(raw);
    if ((byte & 0xC0U) == 0x80U) continue;  // the rest of a UTF-8 letter
    if (std::isalpha(byte) != 0 || byte >= 0x80U || std::isdigit(byte) != 0) {
      sounds_.push_back({t, shape_of(static_cast<char>(std::tolower(byte)))});
      t += std::isdigit(byte) != 0 ? 0.22 : 0.068;
    } else {
      sounds_.push_back({t, {}});
      t += byte == '.' || byte == '!' || byte == '?' ? 0.3 : byte == ',' || byte == ';' ? 0.2 : 0.05;
    }
  }
  sounds_.push_back({t, {}});
  // A subtitle has to be read, too.
  duration_s_ = std::max(1.2, t + 0.4);
}

MouthShape Utterance::at(double t_s) const {
  MouthShape mix;
  float sum = 0;
  // Sounds run into each other: a soft window over some of them.
  constexpr double width_s = 0.085;
  auto next = std::lower_bound(sounds_.begin(), sounds_.end(), t_s - width_s,
                               [](const Sound& sound, double t) { return sound.start_s < t; });
  for (; next != sounds_.end() && next->start_s < t_s + width_s; ++next) {
    const float w = bump(static_cast<float>((t_s - next->start_s) / (2 * width_s) + 0.5));
    mix.open += w * next->shape.open;
    mix.wide += w * next->shape.wide;
    mix.round += w * next->shape.round;
    mix.press += w * next->shape.press;
    sum += w;
  }
  if (sum < 1e-4F) return {};
  const float k = 1 / std::max(sum, 0.5F);
  return {mix.open * k, mix.wide * k, mix.round * k, mix.press * k};
}

}  // namespace counterpart
