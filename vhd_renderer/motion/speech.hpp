// A mouth that moves with what is said: shapes by letter; how wide it opens, and when, by the sound where there is one.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "vhd_renderer/voice/sound.hpp"

namespace counterpart {

struct MouthShape {
  float open = 0;   // jaw and lips apart
  float wide = 0;   // corners back ("ee")
  float round = 0;  // lips forward ("oo")
  float press = 0;  // lips together ("m")
};

class Utterance {
 public:
  Utterance() = default;

  // `sound`: the same text spoken, or null: then letters follow each other at a usual pace.
  explicit Utterance(const std::string& text, const Sound* sound = nullptr);

  double duration_s() const { return duration_s_; }
  MouthShape at(double t_s) const;

 private:
  struct Letter {
    double start_s = 0;
    MouthShape shape;
  };

  void fit_to(const Sound& sound);
  float loudness(double t_s) const;

  std::vector<Letter> letters_;
  std::vector<float> loudness_;  // 0..1, a value every window; empty: no sound
  double duration_s_ = 0;
};

}  // namespace counterpart
