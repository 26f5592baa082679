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

// How far a table goes beyond the board towards him where the scene has no box named "table".
inline constexpr float usual_table_beyond_board_m = 0.19F;

inline constexpr float chair_seat_m = 0.45F;  // over the floor

// Places in the seat frame S, measured from the board, the table and the body.
struct Home {
  float floor_z = -0.74F;
  float table_z = -0.015F;
  float table_edge_y = -0.42F;  // of the table, on his side
  float board_half_m = 0.23F;   // half a side of the board, its rim included
  float seat_y = -0.51F;        // of the hips when he sits at the board
  float seat_hip_z = -0.19F;    // height of the hip joints then
  float chair_back_y = -0.90F;  // of the hips when he has just sat down
  Place chair;                  // standing before the chair
  Place entrance;
  Place away;
  std::array<Eigen::Vector3f, 2> rest_wrist{};  // on the table, hands at rest
  std::array<Place, 2> seat_feet;
};

// `rest_depth_m`: see resting_depth_m.
Home home_of(const Scene& scene, const Anatomy& anatomy, const std::array<float, 2>& rest_depth_m = {0.03F, 0.03F});

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

// How far a resting hand's skin reaches below its wrist: by so much the wrist is over the table.
float resting_depth_m(const Figure& figure, const HandParts& hand, std::size_t side);

}  // namespace counterpart
