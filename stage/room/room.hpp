// The simulated room: everything that a camera sees of it, drawn for one moment.
#pragma once

#include <memory>
#include <optional>

#include <opencv2/core/mat.hpp>

#include "protocol/vocabulary/result.hpp"
#include "stage/player/world.hpp"
#include "vhd_renderer/draw/renderer.hpp"

namespace counterpart::stage {

class SeatedBody;

struct RoomOptions {
  int width = 720;
  int height = 576;
  BoardGeometry board;
  Eigen::Vector3f light_direction_R{-0.45f, 0.25f, 0.85f};
  const SeatedBody* body = nullptr;  // the player, if he is seen in whole; has to outlive the room
  std::vector<ObjectPlan> objects;   // those that a world may hold, in its order
  double warp_m = 0;                 // by so much the board's top is off its plane at most
  std::uint64_t warp_seed = 1;       // of the way it is
  bool fine = false;                 // cuts flat things finer, for a lens that bends lines
  std::uint64_t seed = 1;            // of the grain of the wood
};

class Room {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Room>> furnish(const RoomOptions& options);
  ~Room();

  // A clean picture without noise or blur, CV_8UC3. Only the box of it is drawn, if one is given.
  cv::Mat picture(const World& world, const View& view, const std::optional<cv::Rect>& box = {});

  // CV_8UC1: 255 where the player is seen.
  cv::Mat arm_mask(const World& world, const View& view);

 private:
  struct State;
  explicit Room(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace counterpart::stage
