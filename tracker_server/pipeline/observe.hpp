// The life of a frame on the tracker's side, up to the game: pose of the board, then what stands on it.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "protocol/vocabulary/board_geometry.hpp"
#include "protocol/vocabulary/intrinsics.hpp"
#include "protocol/vocabulary/message.hpp"
#include "protocol/vocabulary/occupancy.hpp"
#include "protocol/vocabulary/pose.hpp"
#include "protocol/vocabulary/video.hpp"
#include "tracker_server/camera/camera.hpp"
#include "tracker_server/pieces/piece_reader.hpp"

namespace counterpart {

struct ObserveOptions {
  BoardGeometry board;
  std::optional<Intrinsics> intrinsics;  // empty: estimated from the board
  std::optional<std::array<double, 8>>
      corners_px;  // outer corners of the playing surface, any order; empty: found unaided
  bool read_pieces = true;
  ReadingMethod method = ReadingMethod::appearance;
  bool lockstep = false;
};

struct Observation {
  PoseEstimate pose;
  Intrinsics intrinsics;                  // those the pose was fitted with; a new id when they change
  std::optional<Occupancy> occupancy;     // empty while the pose is not good enough to read squares
  std::optional<Mask> mask;               // what covers the board
  DebugView debug;                        // projected model and edge points
  std::map<std::string, double> step_ms;  // time of each step, by its name
};

// What must be remembered from frame to frame. Owned by the caller; a new one starts afresh.
class ObserveContext {
 public:
  explicit ObserveContext(const ObserveOptions& options);
  ObserveContext(ObserveContext&&) noexcept;
  ~ObserveContext();

  // Forgets the pose and searches again, from these corners if given.
  void restart(const std::optional<std::array<double, 8>>& corners_px);

  // Forgets what squares and pieces look like: the light is another one for good.
  void read_again();

  // Which pieces the game expects now (one of "wbWBe" a square, real pieces only, others 'e'): lets the reader learn
  // what an empty square and a piece look like. Optional; never decides a reading by itself.
  void expect(const std::string& real_squares);

 private:
  friend Observation observe(const Frame& frame, ObserveContext& context);
  struct State;
  std::unique_ptr<State> state_;
};

Observation observe(const Frame& frame, ObserveContext& context);

}  // namespace counterpart
