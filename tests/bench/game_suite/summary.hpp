// Many games as the figures that the report gives.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/bench/game_suite/play.hpp"

namespace counterpart::bench {

nlohmann::json to_json(const Played& game);
Played played_from(const nlohmann::json& json);

// The figures over all games of one method.
nlohmann::json summary_of(const std::vector<Played>& games);

// A table, one column a method: {"appearance": summary, ...}.
std::string table_of(const nlohmann::json& by_method);

}  // namespace counterpart::bench
