// What a living body does while it does nothing: breathes, blinks, looks about, shifts its weight. All of it is a
// function of time and seed.
#pragma once

#include <Eigen/Core>

#include "vhd_renderer/motion/body_controls.hpp"

namespace counterpart {

// Adds breath and small shifts of trunk and head. t_s since the start of the performance.
void add_idle(double t_s, unsigned seed, float seatedness, BodyControls& controls);

// How far the lids are closed by blinking, 0..1.
float blink(double t_s, unsigned seed);

// Small jumps of the eyes about what they are on, metres at one metre's distance.
Eigen::Vector3f saccade(double t_s, unsigned seed);

}  // namespace counterpart
