#include "stage/room/room_object.hpp"

#include <cmath>

namespace counterpart::stage {

RoomObject object_at(const ObjectPlan& plan, double table_z_R_m, double t_s) {
  const double gone = 0.5 - 0.5 * std::cos(2 * 3.14159265358979 * t_s / plan.period_s);
  const Eigen::Vector2d place = plan.place_R_m + gone * plan.by_m;
  RoomObject object{plan.name, plan.kind, plan.size_m};
  const double foot_z = plan.on_floor ? kFloorZ_m : table_z_R_m;
  object.X_RO.translation() = Eigen::Vector3d(place.x(), place.y(), foot_z + plan.size_m.z() / 2);
  object.X_RO.rotate(Eigen::AngleAxisd(plan.turn_rad + gone * plan.swing_rad, Eigen::Vector3d::UnitZ()));
  return object;
}

}  // namespace counterpart::stage
