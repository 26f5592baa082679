#include "vhd_renderer/motion/speech.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "vhd_renderer/motion/curves.hpp"

namespace counterpart {
namespace {

constexpr double window_s = 0.01;  // of the loudness

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

Utterance::Utterance(const std::string& text, const Sound* sound) {
  double t = 0.05;
  for (const char raw : text) {
    const auto byte = static_cast<unsigned char>(raw);
    if ((byte & 0xC0U) == 0x80U) continue;  // the rest of a UTF-8 letter
    if (std::isalpha(byte) != 0 || byte >= 0x80U || std::isdigit(byte) != 0) {
      letters_.push_back({t, shape_of(static_cast<char>(std::tolower(byte)))});
      t += std::isdigit(byte) != 0 ? 0.22 : 0.068;
    } else if (sound == nullptr) {
      letters_.push_back({t, {}});
      t += byte == '.' || byte == '!' || byte == '?' ? 0.3 : byte == ',' || byte == ';' ? 0.2 : 0.05;
    }
  }
  if (sound != nullptr) {
    fit_to(*sound);
    t = sound->duration_s();
  }
  letters_.push_back({t, {}});
  // A subtitle has to be read, too.
  duration_s_ = std::max(1.2, t + (sound == nullptr ? 0.4 : 0.1));
}

// Letters are shared out over the time in which something is to be heard; the pauses are those of the sound.
void Utterance::fit_to(const Sound& sound) {
  const auto per_window = static_cast<std::size_t>(window_s * sound.rate_hz);
  for (std::size_t first = 0; first < sound.samples.size(); first += per_window) {
    double sum = 0;
    const std::size_t last = std::min(first + per_window, sound.samples.size());
    for (std::size_t i = first; i < last; ++i) sum += static_cast<double>(sound.samples[i]) * sound.samples[i];
    loudness_.push_back(static_cast<float>(std::sqrt(sum / static_cast<double>(last - first))));
  }
  std::vector<float> sorted = loudness_;
  std::sort(sorted.begin(), sorted.end());
  const float loud = sorted.empty() ? 0.F : sorted[sorted.size() * 9 / 10];
  if (loud < 1) {  // silence
    loudness_.clear();
    return;
  }
  for (float& one : loudness_) one = unit_clamp(one / loud);
  std::vector<double> heard;  // windows that are heard, up to and with each
  for (const float one : loudness_) heard.push_back((heard.empty() ? 0.0 : heard.back()) + (one > 0.08F ? 1 : 0));
  const double nominal_s = letters_.empty() ? 0 : letters_.back().start_s + 0.068 - letters_.front().start_s;
  const double start_s = letters_.empty() ? 0 : letters_.front().start_s;
  for (Letter& letter : letters_) {
    const double wanted = heard.back() * (letter.start_s - start_s) / nominal_s;
    const auto at = std::upper_bound(heard.begin(), heard.end(), wanted);
    letter.start_s = window_s * static_cast<double>(at - heard.begin());
  }
}

float Utterance::loudness(double t_s) const {
  if (loudness_.empty()) return 1;
  // Lips are slower than sound: a mean over some hundredths of a second.
  float sum = 0;
  float weight = 0;
  for (int k = -4; k <= 4; ++k) {
    const auto i = static_cast<std::ptrdiff_t>(std::floor(t_s / window_s)) + k;
    const float w = bump(0.5F + static_cast<float>(k) / 10.F);
    weight += w;
    if (i >= 0 && i < static_cast<std::ptrdiff_t>(loudness_.size())) sum += w * loudness_[static_cast<std::size_t>(i)];
  }
  return unit_clamp(1.5F * sum / weight);
}

MouthShape Utterance::at(double t_s) const {
  MouthShape mix;
  float sum = 0;
  // Sounds run into each other: a soft window over some of them.
  constexpr double width_s = 0.085;
  auto next = std::lower_bound(letters_.begin(), letters_.end(), t_s - width_s,
                               [](const Letter& letter, double t) { return letter.start_s < t; });
  for (; next != letters_.end() && next->start_s < t_s + width_s; ++next) {
    const float w = bump(static_cast<float>((t_s - next->start_s) / (2 * width_s) + 0.5));
    mix.open += w * next->shape.open;
    mix.wide += w * next->shape.wide;
    mix.round += w * next->shape.round;
    mix.press += w * next->shape.press;
    sum += w;
  }
  if (sum < 1e-4F) return {};
  const float k = loudness(t_s) / std::max(sum, 0.5F);
  return {mix.open * k, mix.wide * k, mix.round * k, mix.press * k};
}

}  // namespace counterpart
