// The real-time policy in one place: one frame in work, one waiting, the rest dropped and counted.
#pragma once

#include "tracker_server/camera/camera.hpp"

namespace counterpart {

// Reads `source` in a thread of its own. Frames of a source that is faster than its own stamps (a film, a folder) are
// held back until they are due.
[[nodiscard]] std::unique_ptr<Camera> newest_wins(std::unique_ptr<Camera> source);

}  // namespace counterpart
