// The grasp of the paper (section 4) as a function of time: reach, close the hand, carry over the hops, let go, draw
// back. It plans where the hand has to be; the body solver gets it there.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vhd_renderer/motion/body_controls.hpp"
#include "vhd_renderer/motion/grip.hpp"

namespace counterpart {

// A place of a piece and how the hand is turned when it is there.
struct GraspPoint {
  Eigen::Vector3f foot_S{0, 0, 0};
  float heading_rad = 0;  // about z from S's y axis
};

struct GraspTask {
  std::size_t side = right_side;
  bool touch_only = false;  // no piece: touch the last point with the forefinger
  GraspPoint from;
  std::vector<GraspPoint> path;  // hops, the last is where it stays
  std::string style;             // "", "slam", "hesitant"; with touch_only "point": he stays there for a second
  double duration_s = 0;         // 0: as long as a person takes
  float clearance_m = 0.03F;     // how high hand and piece are over the board while they travel, at least
};

enum class GraspPhase : std::uint8_t { reach, close, carry, release, retract, done };

const char* phase_name(GraspPhase phase);

struct GraspMoment {
  GraspPhase phase = GraspPhase::reach;
  ArmGoal goal;
  Eigen::Vector3f target_S{0, 0, 0};  // where the grip's centre has to be in this phase's end
  Eigen::Vector3f held_S{0, 0, 0};    // where the grip's centre is planned to be now
  float heading_rad = 0;              // of the hand, now
  bool holds = false;
};

class GraspMotion {
 public:
  // `start`: where the hand is; `rest`: where it goes afterwards.
  GraspMotion(const GraspTask& task, const Grip& grip, const Figure& figure, const HandParts& hand,
              const ArmGoal& start, const ArmGoal& rest);

  double duration_s() const { return end_s_.back(); }
  GraspMoment at(double t_s) const;
  double start_of(GraspPhase phase) const;
  const GraspTask& task() const { return task_; }
  const Eigen::Isometry3f& X_WP() const { return X_WP_; }  // what is brought to the points of the task

 private:
  struct Hop {
    GraspPoint a;
    GraspPoint b;
    double start_s = 0;
    double end_s = 0;
    float lift_m = 0;
  };

  ArmGoal goal_for(const GraspPoint& point, const HandShape& shape) const;
  ArmGoal between(const ArmGoal& free_hand, const GraspPoint& point, const HandShape& open, float u) const;

  GraspTask task_;
  Grip grip_;
  ArmGoal start_;
  ArmGoal rest_;
  HandShape touch_shape_;
  Eigen::Isometry3f X_WP_ = Eigen::Isometry3f::Identity();
  std::vector<Hop> hops_;
  std::array<double, 5> end_s_{};  // of reach, close, carry, release, retract
};

// For touching instead of holding: the forefinger's tip takes the place of the piece's foot in the grip X_WP.
Eigen::Isometry3f touch_frame(const Figure& figure, const HandParts& hand, const HandShape& shape,
                              const Eigen::Isometry3f& X_WP);

// The wrist pose that holds a piece whose foot is at a point, the hand pointing along `heading`.
ArmGoal holding(const Eigen::Isometry3f& X_WP, const GraspPoint& point, const HandShape& shape);

// The way a seated person's hand points when it is at a place of the board.
float natural_heading(std::size_t side, const Eigen::Vector3f& target_S);

}  // namespace counterpart
