// Ctrl-C and a polite kill as a flag that loops look at.
#pragma once

namespace counterpart {

// SIGINT and SIGTERM set the flag from now on; a second one ends the process at once.
void catch_stop_signals();

bool stop_requested();

}  // namespace counterpart
