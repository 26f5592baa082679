#include "stage/film/film.hpp"

#include <cmath>

#include "stage/film/hidden.hpp"

namespace counterpart::stage {

Film::Film(const Scenario& scenario, std::unique_ptr<Room> room)
    : scenario_(scenario), room_(std::move(room)), world_(starting_world(scenario.board)), player_(scenario.player) {
  world_.player_present = scenario.player_present;
  if (scenario.no_pieces) world_.pieces.clear();
}

Result<Film> Film::begin(const Scenario& scenario) {
  RoomOptions options;
  options.width = scenario.intrinsics.width;
  options.height = scenario.intrinsics.height;
  options.board = scenario.board;
  options.light = static_cast<float>(scenario.light);
  Result<std::unique_ptr<Room>> room = Room::furnish(options);
  if (!room) return tl::make_unexpected(room.error());
  return Film(scenario, std::move(*room));
}

Shot Film::next() {
  const double dt_s = 1 / scenario_.fps;
  const double t_s = static_cast<double>(next_frame_) * dt_s;
  if (next_frame_ > 0) player_.step(dt_s, world_);
  const View before = view_;
  view_ = {scenario_.intrinsics, camera_at(scenario_.path, t_s)};

  Shot shot;
  shot.image_bgr = room_->picture(world_, view_);
  expose(shot.image_bgr, scenario_.sensor, scenario_.seed, next_frame_);
  Truth& truth = shot.truth;
  truth.stamp = {next_frame_, std::llround(t_s * 1e9)};
  truth.view = view_;
  truth.playing_surface_m = scenario_.board.squares * scenario_.board.square_size_m;
  truth.occupancy = occupancy_of(world_);
  const Hidden hidden = hidden_shares(world_, view_);
  truth.hand_share = hidden.surface_by_arm;
  truth.edges_hidden = hidden.edges;
  if (next_frame_ > 0) {
    const double half = scenario_.board.squares * scenario_.board.square_size_m / 2;
    for (const double x : {-half, half}) {
      for (const double y : {-half, half}) {
        truth.motion_px += (project(view_, {x, y, 0}) - project(before, {x, y, 0})).norm() / 4;
      }
    }
  }
  ++next_frame_;
  return shot;
}

cv::Mat Film::arm_mask() {
  return room_->arm_mask(world_, view_);
}

}  // namespace counterpart::stage
