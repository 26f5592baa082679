// Memory for programs through which pictures go.
#pragma once

namespace counterpart {

// A picture's memory stays with the program when it is done with, up to 64 MiB: the system would clear it for the next
// picture, which costs as much as receiving it. For the beginning of a daemon.
void keep_picture_memory();

}  // namespace counterpart
