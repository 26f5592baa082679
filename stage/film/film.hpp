// One run of the stage, frame by frame: time passes for the player and the camera, then a picture is taken.
#pragma once

#include <memory>

#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/stamp.hpp"
#include "stage/player/seated_body.hpp"
#include "stage/scenario/scenario.hpp"

namespace counterpart::stage {

struct ObjectTruth {
  std::string name;
  Eigen::Isometry3d X_CO = Eigen::Isometry3d::Identity();
  double edges_hidden = 0;  // see object_edges_hidden
};

// What was so at the middle of the exposure. Written for those who measure; nobody on the link gets it.
struct Truth {
  FrameStamp stamp;
  View view;
  std::string occupancy;     // of the real pieces, see occupancy_of
  bool holds_piece = false;  // in his hand: it stands nowhere
  double hand_share = 0;     // of the playing surface, hidden by the player
  double edges_hidden =
      0;  // share of the outline's and the grid's length in the picture hidden by arm or pieces, or outside it
  double motion_px = 0;  // how far the board's corners moved since the frame before, the mean of four
  BoardGeometry board;
  bool board_present = true;
  std::vector<ObjectTruth> objects;
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

  // Lets a frame's time pass without taking its picture.
  void skip();

  // Where the player is seen in the last picture: CV_8UC1, 255 = player.
  cv::Mat arm_mask();

  // Why the player looks different from what the scenario asks for; empty: he does not.
  const std::string& warning() const { return warning_; }

  const Scenario& scenario() const { return scenario_; }
  const World& world() const { return world_; }
  const Player& player() const { return player_; }

 private:
  Film(const Scenario& scenario, std::unique_ptr<SeatedBody> body, std::unique_ptr<Room> room);
  // What stands and happens in the room without the player.
  void set_scene(World& world, double t_s) const;
  View view_at(double t_s, const World& world) const;
  // Lets time pass in the room up to t_s; time never runs backwards.
  void pass_until(double t_s);
  cv::Mat expose_frame(double t_s);

  Scenario scenario_;
  std::unique_ptr<SeatedBody> body_;  // null: the player's arm alone is seen
  std::unique_ptr<Room> room_;
  std::string warning_;
  World world_;  // at the middle of the last exposure
  World now_;    // where the last partial exposure left it
  double now_s_ = 0;
  Player player_;
  FrameId next_frame_ = 0;
  View view_;
};

}  // namespace counterpart::stage
