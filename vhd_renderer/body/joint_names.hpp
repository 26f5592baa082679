// One set of joint names for every source: H-Anim 1.1 where it has one, with "l_"/"r_" sides.
#pragma once

#include <string>
#include <string_view>

namespace counterpart {

// "upperarm01.L", "mixamorig:LeftArm", "J_Bip_L_UpperArm" -> "l_shoulder"; names nobody knows come back unchanged.
std::string hanim_name(std::string_view source_name);

}  // namespace counterpart
