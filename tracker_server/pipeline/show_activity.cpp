#include "tracker_server/pipeline/show_activity.hpp"

namespace counterpart {

GameOutputs ShowActivity::step(const Observation& observation, const GameOptions& options, bool renderer_joined) {
  wanted_ = wanted_ || renderer_joined;
  GameOutputs outputs;
  if (!wanted_) return outputs;
  if (!show_ && observation.occupancy) {
    show_ = plan_show(*observation.occupancy, options.board, options.virtual_side, options.table_height_m);
  }
  if (!show_) return outputs;
  outputs.scene = show_->scene;
  outputs.commands = show_->commands;
  wanted_ = false;
  return outputs;
}

}  // namespace counterpart
