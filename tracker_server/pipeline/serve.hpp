// The daemon: camera → pose → pieces → game → commands, one frame after another, and everything published to the peers.
#pragma once

#include <cstdint>
#include <string>

#include "game_controller/engine/opponent.hpp"
#include "game_controller/game/game.hpp"
#include "protocol/transport/endpoint.hpp"
#include "protocol/vocabulary/result.hpp"
#include "tracker_server/camera/camera.hpp"
#include "tracker_server/pipeline/observe.hpp"

namespace counterpart {

enum class Activity {
  game = 1,  // plays draughts
  show = 2,  // points at a real piece, sets down a virtual one and moves it: for films, which answer nothing
};

struct ServeOptions {
  std::string camera_uri;
  CameraAccess camera_access;  // for a vhp:// camera
  std::string listen = "127.0.0.1:7401";
  LinkOptions link;
  ObserveOptions observe;
  GameOptions game;
  OpponentOptions opponent;
  Activity activity = Activity::game;
  bool lockstep = false;     // every frame, in order; the next one only when the renderer has composited the last
  std::uint64_t frames = 0;  // stop after so many; 0: until the camera ends
  std::string state_folder;  // where the game is kept so that it survives this process; empty: nowhere
  std::string pdn_file;      // the game, written anew with every move; empty: nowhere
  std::string poses_file;    // CSV, a line a frame; empty: nowhere
  std::string report_file;   // JSON at the end; empty: nowhere
};

// Returns when the camera has ended, the number of frames is reached, or a stop signal came.
[[nodiscard]] Result<void> serve(const ServeOptions& options);

}  // namespace counterpart
