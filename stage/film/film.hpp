// One run of the stage, frame by frame: time passes for the player and the camera, then a picture is taken.
#pragma once

#include <memory>

#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/stamp.hpp"
#include "stage/scenario/scenario.hpp"

namespace counterpart::stage {

// What was so at the middle of the exposure. Written for those who measure; nobody on the link gets it.
struct Truth {
  FrameStamp stamp;
  View view;
  std::string occupancy;  // of the real pieces, see occupancy_of
  double playing_surface_m = 0;  // a side of the board's playing surface
  double hand_share = 0;  // of the playing surface, hidden by the player's arm
  double edges_hidden = 0;  // share of the outline's and the grid's length in the picture hidden by arm or pieces, or outside it
  double motion_px = 0;   // how far the board's corners moved since the frame before, the mean of four
};

struct Shot {
  cv::Mat image_bgr;
  Truth truth;
};

class Film {
 public:
  [[nodiscard]] static Result<Film> begin(const Scenario& scenario);

  // What the mirror shows the player.
  void show(const BoardState& state) { player_.see(state); }

  // Lets a frame's time pass (none before the first) and takes the picture.
  Shot next();

  // Where the player's arm is seen in the last picture: CV_8UC1, 255 = arm.
  cv::Mat arm_mask();

  const Scenario& scenario() const { return scenario_; }
  const World& world() const { return world_; }

 private:
  Film(const Scenario& scenario, std::unique_ptr<Room> room);

  Scenario scenario_;
  std::unique_ptr<Room> room_;
  World world_;
  Player player_;
  FrameId next_frame_ = 0;
  View view_;
};

}  // namespace counterpart::stage
