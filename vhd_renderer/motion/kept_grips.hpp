// Grips that were fitted before. A fit takes tenths of a second, and the same figure grips the same pieces every day.
#pragma once

#include <filesystem>
#include <functional>

#include "vhd_renderer/motion/grip.hpp"

namespace counterpart {

// Where a director gets its grips from: `grip_on_piece` itself, or what is kept.
using GripSource = std::function<Grip(const Figure& figure, const HandParts& hand, const GripTarget& target)>;

// Fits what is not in the folder yet and keeps it there, by a fingerprint of the hand's skin and the pieces. A file
// that is damaged is fitted anew; a folder that cannot be written keeps nothing. The grip is the same to the last bit.
GripSource grips_kept_in(const std::filesystem::path& folder);

}  // namespace counterpart
