// How the simulated player's hand goes about it: smooth strokes from point to point, with pieces taken and put down.
#pragma once

#include <deque>

#include "stage/player/world.hpp"

namespace counterpart::stage {

enum class StrokeEnd { nothing = 1, take = 2, put_down = 3, crown = 4, knock = 5 };

struct Stroke {
  Eigen::Vector3d to_B{0, 0, 0};  // of the pinch point
  double duration_s = 0.5;
  double arc_m = 0;  // height of the path's middle above the straight line
  StrokeEnd end = StrokeEnd::nothing;
  int piece = -1;                   // taken, put down, knocked over, or crowned with the one in the hand
  int square = 0;                   // where it then stands; 0: off the board
  Eigen::Vector3d foot_B{0, 0, 0};  // where its foot is put down, or where it comes to lie
};

class Gestures {
 public:
  void add(const Stroke& stroke) { strokes_.push_back(stroke); }
  bool idle() const { return strokes_.empty(); }
  // Lets time pass: moves the hand and what it holds.
  void step(double dt_s, World& world);

 private:
  void tumble(const Stroke& stroke, double t, World& world) const;
  void finish(const Stroke& stroke, World& world);
  std::deque<Stroke> strokes_;
  double progress_s_ = 0;
  Eigen::Vector3d from_B_{0, 0, 0};
  Eigen::Vector3d piece_from_B_{0, 0, 0};  // of what is knocked over
};

// How far above a piece's foot the finger tips hold it.
double grip_height_m(const BoardGeometry& board);

}  // namespace counterpart::stage
