// What happens on the stage, from a JSON file. stage/scenarios holds examples; an unknown key is answered with those there are.
#pragma once

#include <string>

#include "protocol/vocabulary/intrinsics.hpp"
#include "protocol/vocabulary/result.hpp"
#include "stage/camera/path.hpp"
#include "stage/camera/sensor.hpp"
#include "stage/player/player.hpp"
#include "stage/room/room.hpp"

namespace counterpart::stage {

struct Scenario {
  std::string name = "unnamed";
  std::string about;
  std::uint64_t seed = 1;
  int frames = 250;
  double fps = 25;
  Intrinsics intrinsics{1, 720, 576, 610, 610, 359.5, 287.5, {}};
  BoardGeometry board;
  bool no_pieces = false;  // an empty board
  CameraPath path;
  SensorOptions sensor;
  bool player_present = true;
  PlayerOptions player;
  double light = 1;
};

// Failures name the line, the key and what is allowed there.
[[nodiscard]] Result<Scenario> parse_scenario(const std::string& text);
[[nodiscard]] Result<Scenario> load_scenario(const std::string& path);

// Everything that is drawn by chance follows from this one number.
void reseed(Scenario& scenario, std::uint64_t seed);

}  // namespace counterpart::stage
