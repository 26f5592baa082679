// What a simulated game is to be like: room, camera, light, board and everything that goes wrong, drawn by a seed.
#pragma once

#include <cstdint>

#include "stage/scenario/scenario.hpp"

namespace counterpart::bench {

// The scenario of the n-th game of a suite; the same numbers give the same game. Over the games every mishap that the
// stage knows occurs; `plies` says over how long a game they are spread.
stage::Scenario plan_game(std::uint64_t suite_seed, int number, int plies);

}  // namespace counterpart::bench
