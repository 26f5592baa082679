#include "stage/player/gesture.hpp"

#include <algorithm>

namespace counterpart::stage {
namespace {

// The speed profile of people's reaching: least jerk (Flash and Hogan 1985).
double least_jerk(double t) {
  return t * t * t * (10 + t * (-15 + 6 * t));
}

}  // namespace

double grip_height_m(const BoardGeometry& board) {
  return 0.8 * board.piece_height_m;
}

void Gestures::step(double dt_s, World& world) {
  while (!strokes_.empty()) {
    const Stroke& stroke = strokes_.front();
    if (progress_s_ == 0) {
      from_B_ = world.hand.pinch_B;
      if (stroke.piece >= 0) piece_from_B_ = world.pieces[static_cast<std::size_t>(stroke.piece)].p_B;
    }
    const double used = std::min(dt_s, stroke.duration_s - progress_s_);
    progress_s_ += used;
    dt_s -= used;
    const double t = stroke.duration_s > 0 ? std::clamp(progress_s_ / stroke.duration_s, 0.0, 1.0) : 1.0;
    const double s = least_jerk(t);
    world.hand.pinch_B = from_B_ + s * (stroke.to_B - from_B_);
    world.hand.pinch_B.z() += stroke.arc_m * 16 * s * s * (1 - s) * (1 - s);
    if (stroke.end == StrokeEnd::knock) tumble(stroke, t, world);
    if (world.hand.held_piece >= 0) {
      RealPiece& held = world.pieces[static_cast<std::size_t>(world.hand.held_piece)];
      held.p_B = world.hand.pinch_B - Eigen::Vector3d(0, 0, grip_height_m(world.board));
    }
    if (progress_s_ < stroke.duration_s) return;
    finish(stroke, world);
    strokes_.pop_front();
    progress_s_ = 0;
    if (dt_s <= 0) return;
  }
}

void Gestures::tumble(const Stroke& stroke, double t, World& world) const {
  constexpr double kHop_m = 0.02;
  constexpr double kHalfTurn = 3.14159265358979;
  RealPiece& piece = world.pieces[static_cast<std::size_t>(stroke.piece)];
  piece.square = 0;
  piece.p_B = piece_from_B_ + t * (stroke.foot_B - piece_from_B_);
  piece.p_B.z() += kHop_m * 4 * t * (1 - t);
  piece.roll_rad = kHalfTurn * t;
}

void Gestures::finish(const Stroke& stroke, World& world) {
  if (stroke.end == StrokeEnd::nothing || stroke.piece < 0) return;
  RealPiece& piece = world.pieces[static_cast<std::size_t>(stroke.piece)];
  switch (stroke.end) {
    case StrokeEnd::take:
      world.hand.held_piece = stroke.piece;
      piece.square = 0;
      piece.roll_rad = 0;  // the fingers turn it the right way up
      break;
    case StrokeEnd::put_down:
      world.hand.held_piece = -1;
      piece.square = stroke.square;
      piece.p_B = stroke.foot_B;
      break;
    case StrokeEnd::crown: {
      // The piece in the hand becomes the upper half of a king and is no piece of its own any more.
      piece.king = true;
      const int crown = world.hand.held_piece;
      world.hand.held_piece = -1;
      if (crown >= 0) world.pieces[static_cast<std::size_t>(crown)].p_B = Eigen::Vector3d(0, 0, -100);
      break;
    }
    case StrokeEnd::knock:
    case StrokeEnd::nothing:
      break;
  }
}

}  // namespace counterpart::stage
