// Something of flat faces that stands in the room at one moment, and how it gets about. R: the room's frame, that of
// the board where it first lies.
#pragma once

#include <string>

#include <Eigen/Geometry>

#include "stage/room/polygon_model.hpp"

namespace counterpart::stage {

inline constexpr double kFloorZ_m = -0.755;  // in R

// The table on which the board lies, in R.
inline constexpr float kTableX_m = 1.3f;
inline constexpr float kTableNearY_m = 0.52f;  // the real player's edge
inline constexpr float kTableFarY_m = -0.42f;  // the virtual player's edge
inline constexpr float kTableThickness_m = 0.03f;

struct RoomObject {
  std::string name;
  ObjectKind kind = ObjectKind::box;
  Eigen::Vector3d size_m{0, 0, 0};
  Eigen::Isometry3d X_RO = Eigen::Isometry3d::Identity();
};

struct ObjectPlan {
  std::string name;
  ObjectKind kind = ObjectKind::box;
  Eigen::Vector3d size_m{0, 0, 0};
  bool on_floor = false;  // otherwise on the table
  Eigen::Vector2d place_R_m{0, 0};
  double turn_rad = 0;
  Eigen::Vector2d by_m{0, 0};  // it slides to and fro between its place and so far from it
  double swing_rad = 0;        // and turns by so much while it does
  double period_s = 8;
};

// table_z_R_m: of the table's top.
RoomObject object_at(const ObjectPlan& plan, double table_z_R_m, double t_s);

}  // namespace counterpart::stage
