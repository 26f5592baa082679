// The real player in whole: a figure of the human builder, seated on his side of the board; his right hand goes where
// the player's hand is.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "protocol/vocabulary/result.hpp"
#include "stage/player/world.hpp"
#include "stage/room/blend_mesh.hpp"
#include "vhd_renderer/body/figure.hpp"

namespace counterpart::stage {

// How he sits at one moment, in the room's frame R.
struct SeatedPose {
  std::vector<Eigen::Isometry3f> X_RJ;  // of every joint of the figure
  std::vector<float> face;              // weight of each morph, in order of SeatedBody::morph_names
  Eigen::Isometry3f X_RChair = Eigen::Isometry3f::Identity();
  std::vector<Capsule> shape_R;  // what he hides, roughly: see limb_capsules
};

class SeatedBody {
 public:
  // Fails where the figure is not to be had or lacks a joint.
  [[nodiscard]] static Result<std::unique_ptr<SeatedBody>> seat(const std::string& figure, const BoardGeometry& board);
  ~SeatedBody();

  // Goes on to this time, his hand to where the player's is, and puts his pose into the world.
  void pass(double t_s, World& world);

  const Figure& figure() const;
  const std::vector<std::string>& morph_names() const;

 private:
  struct State;
  explicit SeatedBody(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// A capsule for each joint round the vertices that follow it most, in that joint's own frame; a radius of 0 where a
// joint moves hardly any.
std::vector<Capsule> limb_capsules(const Figure& figure);

}  // namespace counterpart::stage
