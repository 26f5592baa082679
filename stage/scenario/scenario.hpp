// What happens on the stage, from a JSON file. stage/scenarios holds examples; an unknown key is answered with those
// there are.
#pragma once

#include <string>
#include <vector>

#include "protocol/vocabulary/intrinsics.hpp"
#include "protocol/vocabulary/result.hpp"
#include "stage/camera/path.hpp"
#include "stage/camera/sensor.hpp"
#include "stage/film/events.hpp"
#include "stage/player/player.hpp"
#include "stage/room/room.hpp"

namespace counterpart::stage {

// How the exposure spreads over time. The stamped time is the middle of it all.
struct Shutter {
  double open_s = 0;        // motion blur: how long each row gathers light; 0: a moment
  int samples = 7;          // moments that stand for that time
  double readout_s = 0;     // rolling shutter: from the first row's time to the last one's
  bool interlaced = false;  // two fields, the even rows' half a period before the odd rows'
};

struct Scenario {
  std::string name = "unnamed";
  std::string about;
  std::uint64_t seed = 1;
  int frames = 250;
  double fps = 25;
  Intrinsics intrinsics{1, 720, 576, 610, 610, 359.5, 287.5, {}};
  BoardGeometry board;
  double warp_m = 0;       // by so much the board's top is off its plane at most
  bool no_pieces = false;  // an empty board
  bool no_board = false;   // objects alone
  std::vector<ObjectPlan> objects;
  CameraPath path;
  SensorOptions sensor;
  Shutter shutter;
  std::vector<Event> events;
  bool player_present = true;
  std::string player_figure;  // whom he looks like; empty: his arm alone is seen
  PlayerOptions player;
  double light = 1;
};

// Failures name the line, the key and what is allowed there.
[[nodiscard]] Result<Scenario> parse_scenario(const std::string& text);
[[nodiscard]] Result<Scenario> load_scenario(const std::string& path);

// Everything that is drawn by chance follows from this one number.
void reseed(Scenario& scenario, std::uint64_t seed);

}  // namespace counterpart::stage
