// A plain jointed figure, 1.75 m tall, made of capsules and ellipsoids; it needs no data.
#pragma once

#include "vhd_renderer/body/figure.hpp"

namespace counterpart {

Figure mannequin();

}  // namespace counterpart
