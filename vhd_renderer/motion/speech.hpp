// A mouth that moves with what is said: shapes by sound, from the text alone.
#pragma once

#include <map>
#include <string>
#include <vector>

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
  explicit Utterance(const std::string& text);

  double duration_s() const { return duration_s_; }
  MouthShape at(double t_s) const;

 private:
  struct Sound {
    double start_s = 0;
    MouthShape shape;
  };
  std::vector<Sound> sounds_;
  double duration_s_ = 0;
};

}  // namespace counterpart
