// Levels of detail: a figure with as many triangles as a picture can show.
#pragma once

#include "vhd_renderer/body/figure.hpp"

namespace counterpart {

// The same figure with fewer triangles, its surface moved by no more than about `error_m` anywhere (half of that where a
// face moves); seams of textures stay closed. Vertices that are no longer used are gone. error_m 0: as it was.
Figure simplified(const Figure& figure, float error_m);

}  // namespace counterpart
