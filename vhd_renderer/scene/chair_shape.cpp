#include "vhd_renderer/scene/chair_shape.hpp"

#include "vhd_renderer/motion/stance.hpp"

namespace counterpart {

MeshData chair_shape() {
  constexpr float leg_m = 0.036f;
  constexpr float half_width_m = 0.205f;
  constexpr float back_y = -0.175f;
  constexpr float front_y = 0.225f;
  constexpr float seat_m = 0.03f;
  constexpr float back_top_m = 0.86f;
  MeshData chair;
  append(chair, box_mesh({2 * half_width_m + leg_m, front_y - back_y + leg_m, seat_m}),
         {0, (front_y + back_y) / 2, chair_seat_m - seat_m / 2});
  const float under = chair_seat_m - seat_m;
  for (const float side : {-1.f, 1.f}) {
    append(chair, box_mesh({leg_m, leg_m, under}), {side * half_width_m, front_y, under / 2});
    append(chair, box_mesh({leg_m, leg_m, back_top_m}), {side * half_width_m, back_y, back_top_m / 2});
  }
  for (const float z : {0.56f, 0.68f, 0.80f}) {
    append(chair, box_mesh({2 * half_width_m, 0.018f, 0.065f}), {0, back_y, z});
  }
  return chair;
}

}  // namespace counterpart
