// `vhd_renderer clips`: the keyframe clips that a director may ask for.
#pragma once

namespace CLI {
class App;
}

namespace counterpart {

void add_clips(CLI::App& app, int& exit_code);

}  // namespace counterpart
