// tracker_server track --object … --rigid …: what is followed beside the board or the model.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "protocol/vocabulary/result.hpp"
#include "tracker_server/pose/object_tracker.hpp"

namespace counterpart {

struct ObjectArguments {
  std::vector<std::string> objects;  // folders with model.obj and init.json, or names of such under SEQUENCE/objects
  std::vector<std::string> rigid;    // "NAME,NAME,...": these keep their places to each other
};

// Objects that are rigid to each other together, the others alone. Those rigid to `main`, which is itself followed
// elsewhere, come apart. Names an object or a rigid group that is at fault.
struct ObjectGroups {
  std::vector<ObjectToTrack> with_main;
  std::vector<std::vector<ObjectToTrack>> others;
};
[[nodiscard]] Result<ObjectGroups> objects_to_track(const ObjectArguments& arguments,
                                                    const std::filesystem::path& sequence, const std::string& main);

}  // namespace counterpart
