// What happens in the room at set times, whoever plays: lights, knocks, cups. Pure functions of the time.
#pragma once

#include <vector>

#include "stage/player/world.hpp"
#include "vhd_renderer/draw/view.hpp"

namespace counterpart::stage {

enum class EventKind {
  lights = 1,       // the light goes to `level` and comes back
  nudge_board = 2,  // the board is pushed by `by_m` and turned by `turn_rad`, and stays there
  bump_camera = 3,  // the camera is turned by `turn_rad` sideways, swings, and stays there
  look_away = 4,    // the camera turns away by `turn_rad` and comes back
  cup = 5,          // a cup is put down on the table at `by_m` from the board's middle and taken away
  defocus = 6,      // the picture blurs by `blur_px`
  cover = 7,        // a newspaper hides `share` of the board's lines
};

struct Event {
  EventKind kind = EventKind::lights;
  double at_s = 0;
  double for_s = 1;  // nudge_board: how long the push takes; otherwise until all is as before
  double level = 0.05;
  Eigen::Vector2d by_m{0, 0};
  double turn_rad = 0;
  double blur_px = 2;
  double share = 0.5;
};

// Sets the room's light, cup and board to what they are at the time. light: without any event.
void apply_events(const std::vector<Event>& events, double t_s, double light, World& world);

// What knocks and looks aside add to the camera's pose: C' from C.
Eigen::Isometry3d camera_turn(const std::vector<Event>& events, double t_s);

// Standard deviation of the blur that defocusing adds, in pixels.
double defocus_px(const std::vector<Event>& events, double t_s);

// Lays the newspaper so that the event's share of the board's lines is hidden in this view, all hiding things counted;
// takes it away when no such event is on.
void cover_board(const std::vector<Event>& events, double t_s, const View& view, World& world);

}  // namespace counterpart::stage
