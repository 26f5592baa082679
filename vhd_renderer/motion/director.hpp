// The Virtual Human Director: commands in, a body and feedback out, one step a frame. Time is the capture time of the
// frame that will be composited; nothing here reads a clock.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "protocol/vocabulary/command.hpp"
#include "protocol/vocabulary/result.hpp"
#include "protocol/vocabulary/scene.hpp"
#include "vhd_renderer/body/figure.hpp"
#include "vhd_renderer/motion/clip.hpp"
#include "vhd_renderer/motion/kept_grips.hpp"
#include "vhd_renderer/voice/sound.hpp"

namespace counterpart {

struct DirectorInputs {
  std::int64_t now_ns = 0;
  std::vector<Command> commands;  // new ones; the same id twice is answered again, not done again
  const Scene* scene = nullptr;   // a new snapshot, or null
  Point3 camera_B{0, 1, 0.5};     // where the camera is, for gaze
  Point3 player_B{0, 0.8, 0.4};   // where the real player's head is supposed to be
};

struct StagedPiece {
  std::string name;
  Side side = Side::light;
  bool king = false;
  Eigen::Isometry3f X_BP = Eigen::Isometry3f::Identity();  // P: centre of the foot, z up
};

struct Performance {
  std::vector<Eigen::Isometry3f> X_BJ;    // of every joint of the figure, in B
  std::vector<float> morphs;              // weight by name order of `Director::morph_names`
  std::vector<StagedPiece> pieces;        // virtual pieces where they are now, in the hand or on the board
  std::optional<Eigen::Isometry3f> X_BC;  // his chair: on the floor under the middle of its seat, y the way it faces
  std::vector<Feedback> feedback;
  std::string subtitle;                // what is being said now; empty: nothing
  std::shared_ptr<const Sound> sound;  // what is being heard now; null: nothing
  double sound_s = 0;                  // where in it
};

class Director {
 public:
  // The figure has to outlive the director. A figure without the joints that motion needs stands still, and every
  // command fails with "no_skeleton". `clips`: what a keyframe command may name.
  explicit Director(const Figure& figure, Speaker speaker = {}, ClipLibrary clips = clip_library(),
                    GripSource grips = grip_on_piece);
  Director(Director&&) noexcept;
  ~Director();

  Performance step(const DirectorInputs& inputs);

  const std::vector<std::string>& morph_names() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Places of the skinned vertices, by part, in B.
struct SkinnedPart {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<Eigen::Vector3f> normals;
};

// Of all its parts, each once, in order.
std::vector<std::string> morph_names_of(const Figure& figure);

void skin(const Figure& figure, const std::vector<std::string>& morph_names, const Performance& performance,
          std::vector<SkinnedPart>& parts);

}  // namespace counterpart
