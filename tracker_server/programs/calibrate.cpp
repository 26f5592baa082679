#include <CLI/CLI.hpp>

#include "tracker_server/programs/programs.hpp"

namespace counterpart {
void add_calibrate(CLI::App&, int&) {}
}  // namespace counterpart
