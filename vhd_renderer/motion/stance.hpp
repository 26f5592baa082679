// Where the human is at home: entrance, chair, seat; how he sits, and how he gets there and away.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "protocol/vocabulary/scene.hpp"
#include "vhd_renderer/motion/body_controls.hpp"
#include "vhd_renderer/motion/walk.hpp"

namespace counterpart {

// Places in the seat frame S, measured from the board and the body.
struct Home {
  float floor_z = -0.74F;
  float seat_y = -0.51F;        // of the hips when he sits at the board
  float seat_hip_z = -0.19F;    // height of the hip joints then
  float chair_back_y = -0.90F;  // of the hips when he has just sat down
  Place chair;                  // standing before the chair
  Place entrance;
  Place away;
  std::array<Eigen::Vector3f, 2> rest_hand{};  // foot of the hand on the table
  std::array<Place, 2> seat_feet;
};

Home home_of(const Scene& scene, const Anatomy& anatomy);

enum class Posture : std::uint8_t { standing, seated };

// One stretch of going somewhere: a walk, sitting down or getting up.
class Stretch {
 public:
  static Stretch walk(Walk walk);
  static Stretch sit_down(const Home& home, const Anatomy& anatomy);
  static Stretch get_up(const Home& home, const Anatomy& anatomy);

  double duration_s() const;
  const char* phase() const;  // "walk", "sit", "stand_up"

  // Fills pelvis, trunk and feet; returns the swing of the arms, and in `seatedness` how much he sits, 0..1.
  float pose(double t_s, const Home& home, const Anatomy& anatomy, BodyControls& controls, float& seatedness) const;

 private:
  enum class Kind : std::uint8_t { walk, sit, up };
  Kind kind_ = Kind::walk;
  Walk walk_;
};

// Standing at a place, sitting at the board.
void stand(const Place& place, const Home& home, const Anatomy& anatomy, BodyControls& controls);
void sit(const Home& home, const Anatomy& anatomy, BodyControls& controls);

// Where an arm is when it has nothing to do.
ArmGoal hanging_arm(const Anatomy& anatomy, const BodyControls& controls, std::size_t side, float swing);
ArmGoal resting_arm(const Home& home, std::size_t side);

}  // namespace counterpart
